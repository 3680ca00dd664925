"""Where a cutter stands free at samples with fixed tool axes, by the certified test."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import SurfaceSamples
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.operations import Columns
from plan_cutters.domain.verdicts import Verdicts
from plan_cutters.plan_file.operations import MARGIN
from plan_cutters.scene.conditions import Conditions, Context
from plan_cutters.scene.fixed_axis import served_by, slid
from plan_cutters.scene.work import Progress, part_of

Rows = NDArray[np.int64]


class Probes:
    """The test of columns at samples, and how often it was made.

    `setups`: of each setup, with its own machine frame, fixtures and obstacles. `outside` (sequence of (n,) bool): of each setup
    the samples that can be machined there: not clamped faces, not inside material. `barred`: index of a cutter -> samples (n,) at
    which it is not to be planned. `everywhere`: of each setup the verdicts by cutter, whose postures serve with their axes.

    `contexts`: of each cutter in each setup. `made`: times that the tool was put down.
    """

    def __init__(
        self, samples: SurfaceSamples, cutters: Sequence[Cutter], setups: Sequence[Conditions],
        outside: Sequence[NDArray[np.bool_]], barred: Mapping[int, NDArray[np.bool_]] | None = None,
        everywhere: Sequence[Mapping[Cutter, Verdicts]] = (),
    ) -> None:  # fmt: skip
        self.barred, self.everywhere = barred or {}, everywhere
        self.samples, self.cutters, self.setups, self.outside, self.made = samples, cutters, setups, outside, 0
        self.contexts = [[Context.of(cutter, setup) for setup in setups] for cutter in cutters]
        self._kept: dict[str, NDArray[np.bool_]] = {}
        self._kept_rows: Rows = np.zeros(0, np.int64)

    def table(self, rows: Rows, columns: Columns, progress: Progress | None = None) -> NDArray[np.bool_]:
        """Where each column serves: (rows, columns)."""
        table = np.zeros((len(columns), len(rows)), bool)
        kinds = {*zip(columns.cutter.tolist(), columns.setup.tolist(), strict=True)}
        for k, (c, s) in enumerate(kinds):
            mine_of = None if progress is None else part_of(progress, k, len(kinds))
            mine = np.flatnonzero((columns.cutter == c) & (columns.setup == s))
            may = self.outside[s][rows]
            open_ = np.flatnonzero(may & ~self.barred[c][rows] if c in self.barred else may)
            if len(open_):
                free, made = served_by(rows[open_], columns.axis[mine], self.samples, self.contexts[c][s], mine_of)
                if self.everywhere:
                    searched = self.everywhere[s][self.cutters[c]]
                    for number, which, _ in slid(rows[open_], columns.axis[mine], self.samples, self.contexts[c][s], searched):
                        free[number, which] = True
                table[np.ix_(mine, open_)] = free
                self.made += made
        return table.T

    def kept(self, rows: Rows, columns: Columns) -> NDArray[np.bool_]:
        """As `table`, for columns that are requested again and again at the same rows."""
        if not np.array_equal(rows, self._kept_rows):
            self._kept, self._kept_rows = {}, rows
        keys = columns.key.tolist()
        new = np.array([k for k, key in enumerate(keys) if key not in self._kept], np.int64)
        if len(new):
            self._kept |= dict(zip((keys[k] for k in new.tolist()), self.table(rows, columns.of(new)).T, strict=True))
        return np.array([self._kept[key] for key in keys], bool).reshape(len(keys), len(rows)).T

    def spacious(self, rows: Rows, columns: Columns, serves: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Where columns that serve (rows, columns) have a margin about neck, shank and holder, too."""
        result, wide = serves.copy(), dict[tuple[int, int], Context]()
        for k, (c, s) in enumerate(zip(columns.cutter.tolist(), columns.setup.tolist(), strict=True)):
            cutter, mine = self.cutters[c], np.flatnonzero(serves[:, k])
            if cutter.stages and len(mine):
                if (c, s) not in wide:
                    wide[c, s] = Context.of(replace(cutter, clearance=max(MARGIN, cutter.clearance or 0.0)), self.setups[s])
                free, made = served_by(rows[mine], columns.axis[[k]], self.samples, wide[c, s])
                result[mine, k] = free[0]
                self.made += made
        return result
