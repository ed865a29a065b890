"""What answers of studies have in common: each prints as its table, with the names of the columns, and draws its picture."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any

from trbdyn.base.shown import Tabled


class Answer(Tabled):
    """The answer of a study; its description says what the picture shows."""

    _headed = True
    _draw: Callable[..., Any]

    def picture(self, path: str | os.PathLike[str] | None = None, *, overwrite: bool = False, **how: Any) -> Any:
        """Draw it.

        Parameters
        ----------
        path : path-like, optional
            Where to save the picture.
        overwrite : bool
            Replace a file that is there.
        **how
            What else the picture can be given; see the description of the class.

        Returns
        -------
        Figure
            The matplotlib figure.
        """
        from trbdyn.plot.style import kept

        return kept(self._draw(**how), path, overwrite=overwrite)
