# SPDX-License-Identifier: BSD-3-Clause
"""Looking at figures."""

import numpy as np

SAMPLES = 21  # pixels across a disc: enough to tell places apart


def written(figure):
    """All text of a figure, drawn or not."""
    return " ".join(text.get_text() for text in figure.findobj(lambda artist: hasattr(artist, "get_text")))


def rendered(figure):
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())
