# SPDX-License-Identifier: BSD-3-Clause
"""python3 -m mmbrdf.report MODEL [DATA.csv] -o REPORT.html, or DATA.csv alone: see mmbrdf.report(), which this module can be
called as."""

import sys
import types

from ._report import main


class _Callable(types.ModuleType):
    """`import mmbrdf.report` puts this module where the function of that name was."""

    def __call__(self, *arguments, **options):
        from . import _write_report

        _write_report(*arguments, **options)


if __name__ == "__main__":
    sys.exit(main())
sys.modules[__name__].__class__ = _Callable
