#!/usr/bin/env python3
"""The check of the rooms must be able to fail."""
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import check_rooms


class Rooms(unittest.TestCase):
    def faults(self, files):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for base in ["include/mmbrdf", "src"]:
                (root / base).mkdir(parents=True)
            for name, text in files.items():
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text)
            return [*check_rooms.upward_arrows(root), *check_rooms.misfits(root), *check_rooms.twins(root)]

    def test_arrows_up_are_found_however_they_are_written(self):
        for line in [
            '#include "mmbrdf/model/model.hpp"',
            "#include <mmbrdf/model/model.hpp>",
            '  # include "model/kernel/pack.hpp"',
            '#include "../model/model.hpp"',
            '#include "mmbrdf/elsewhere/x.hpp"',
        ]:
            found = self.faults({"src/geometry/x.hpp": f"{line}\n"})
            self.assertEqual(len(found), 1, line)
            self.assertIn("src/geometry/x.hpp:1: geometry includes", found[0])

    def test_the_interface_for_c_is_over_all_rooms(self):
        for header in ["<mmbrdf.h>", '"mmbrdf.h"', '"interfaces/c/calls.hpp"']:
            found = self.faults({"src/files/x.hpp": f"#include {header}\n"})
            self.assertEqual(len(found), 1, header)
            self.assertIn("over all rooms", found[0])

    def test_arrows_down_and_libraries_are_not(self):
        text = '#include <vector>\n#include <Eigen/Core>\n#include "mmbrdf/geometry/geometry.hpp"\n#include "model/x.hpp"\n'
        self.assertEqual(self.faults({"src/model/y.hpp": text}), [])

    def test_rooms_that_are_none_too_many_headers_and_sources_without_one_are_found(self):
        self.assertEqual(len(self.faults({"src/util/x.hpp": ""})), 1)
        self.assertEqual(len(self.faults({f"include/mmbrdf/model/{n}.hpp": "" for n in range(9)})), 1)
        self.assertEqual(
            len(self.faults({"src/model/x.cpp": "", "src/model/y.hpp": "", "src/model/y_part.cpp": ""})), 1
        )

    def test_two_types_of_one_name_are_found(self):
        one, other = "struct Field {\n};\n", "class Field : public Base {\n};\nstruct Field;\n"
        self.assertEqual(len(self.faults({"src/files/x.hpp": one, "src/quantities/y.hpp": other})), 1)
        self.assertEqual(self.faults({"src/files/x.hpp": one, "src/files/y.hpp": "namespace {\n" + other}), [])
        self.assertEqual(self.faults({"src/files/x.hpp": one, "src/files/y.hpp": "struct Field;\n"}), [])


if __name__ == "__main__":
    unittest.main()
