"""Where a cutter stands free at samples with fixed tool axes, by the certified test."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, SurfaceSamples
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.operations import Columns
from plan_cutters.domain.verdicts import Verdicts, blank
from plan_cutters.plan_file.operations import MARGIN
from plan_cutters.scene.conditions import Conditions, Context, contacts_of
from plan_cutters.scene.distances import clear_by
from plan_cutters.scene.fixed_axis import served_by, slid
from plan_cutters.scene.flats_and_flanks import search
from plan_cutters.scene.work import Progress, part_of

Rows = NDArray[np.int64]


def roomy(cutter: Cutter) -> Cutter:
    """The same tool with room about its neck, shank and holder."""
    return replace(cutter, clearance=max(MARGIN, cutter.clearance or 0.0))


def with_margin(
    samples: SurfaceSamples,
    rows: Rows,
    everywhere: Sequence[Mapping[Cutter, Verdicts]],
    setups: Sequence[Conditions],
    outside: Sequence[NDArray[np.bool_]],
) -> NDArray[np.bool_]:
    """Samples (n,) of some rows at which one of the cutters has room about it in one of the setups: by the posture that it has,
    else by any other. Arguments as of `Probes`."""  # fmt: skip
    result = np.zeros(len(samples), bool)
    for conditions, open_, by_cutter in zip(setups, outside, everywhere, strict=True):
        for cutter, verdicts in by_cutter.items():
            mine = rows[~result[rows] & open_[rows]]
            result[mine] = clear_by(MARGIN, samples, cutter, verdicts, conditions, mine)
    for conditions, open_, by_cutter in zip(setups, outside, everywhere, strict=True):
        for cutter, verdicts in by_cutter.items():
            mine = rows[~result[rows] & open_[rows] & verdicts.reached[rows]]
            if cutter.stages and len(mine):
                there = blank(len(samples))
                search(
                    contacts_of(samples), samples.face, mine, Context.of(roomy(cutter), conditions), there, fixed=True, brief=True
                )
                result |= there.reached
    return result


class Probes:
    """The test of columns at samples, and how often it was made.

    `setups`: of each setup, with its own machine frame, fixtures and obstacles. `outside` (sequence of (n,) bool): of each setup
    the samples that can be machined there: not clamped faces, not inside material. `barred`: index of a cutter -> samples (n,) at
    which it is not to be planned. `everywhere`: of each setup the verdicts by cutter, whose postures serve with their axes.
    `margin` (n,) bool: where tools are put down with room about them; None: nowhere.

    `contexts`: of each cutter in each setup. `made`: times that the tool was put down.
    """

    def __init__(
        self,
        samples: SurfaceSamples,
        cutters: Sequence[Cutter],
        setups: Sequence[Conditions],
        outside: Sequence[NDArray[np.bool_]],
        barred: Mapping[int, NDArray[np.bool_]] | None = None,
        everywhere: Sequence[Mapping[Cutter, Verdicts]] = (),
        margin: NDArray[np.bool_] | None = None,
    ) -> None:
        self.margin = margin
        self.barred, self.everywhere = barred or {}, everywhere
        self.samples, self.cutters, self.setups, self.outside, self.made = samples, cutters, setups, outside, 0
        self.contexts = [[Context.of(cutter, setup) for setup in setups] for cutter in cutters]
        self._roomy = [[Context.of(roomy(cutter), setup) for setup in setups] if cutter.stages and margin is not None else own
                       for cutter, own in zip(cutters, self.contexts, strict=True)]  # fmt: skip
        self._kept: dict[str, NDArray[np.bool_]] = {}
        self._kept_rows: Rows = np.zeros(0, np.int64)

    def tight(self, rows: Rows, columns: Columns) -> NDArray[np.bool_]:
        """As `table`, with no more room than is required."""
        return self.table(rows, columns, margin=False)

    def table(self, rows: Rows, columns: Columns, progress: Progress | None = None, *, margin: bool = True) -> NDArray[np.bool_]:
        """Where each column serves: (rows, columns)."""
        table = np.zeros((len(columns), len(rows)), bool)
        kinds = {*zip(columns.cutter.tolist(), columns.setup.tolist(), strict=True)}
        for k, (c, s) in enumerate(kinds):
            mine_of = None if progress is None else part_of(progress, k, len(kinds))
            mine = np.flatnonzero((columns.cutter == c) & (columns.setup == s))
            may = self.outside[s][rows]
            open_ = np.flatnonzero(may & ~self.barred[c][rows] if c in self.barred else may)
            if len(open_):
                free, made = self._served(rows[open_], columns.axis[mine], c, s, mine_of, margin=margin)
                if self.everywhere:
                    searched = self.everywhere[s][self.cutters[c]]
                    for number, which, _ in slid(rows[open_], columns.axis[mine], self.samples, self.contexts[c][s], searched):
                        free[number, which] = True
                table[np.ix_(mine, open_)] = free
                self.made += made
        return table.T

    def _served(
        self, rows: Rows, axes: Floats, c: int, s: int, progress: Progress | None, *, margin: bool
    ) -> tuple[NDArray[np.bool_], int]:
        apart = self.margin[rows] if margin and self.margin is not None and self.cutters[c].stages else np.zeros(len(rows), bool)
        free, made = np.zeros((len(axes), len(rows)), bool), 0
        for context, mine in ((self.contexts[c][s], ~apart), (self._roomy[c][s], apart)):
            if mine.any():
                free[:, mine], more = served_by(rows[mine], axes, self.samples, context, progress)
                made += more
        return free, made

    def kept(self, rows: Rows, columns: Columns) -> NDArray[np.bool_]:
        """As `table`, for columns that are requested again and again at the same rows."""
        if not np.array_equal(rows, self._kept_rows):
            self._kept, self._kept_rows = {}, rows
        keys = columns.key.tolist()
        new = np.array([k for k, key in enumerate(keys) if key not in self._kept], np.int64)
        if len(new):
            self._kept |= dict(zip((keys[k] for k in new.tolist()), self.table(rows, columns.of(new)).T, strict=True))
        return np.array([self._kept[key] for key in keys], bool).reshape(len(keys), len(rows)).T

    def one(self, rows: Rows, columns: Columns, which: int) -> NDArray[np.bool_]:
        """Where one column serves: (rows,)."""
        return np.asarray(self.table(rows, columns.of(np.array([which])))[:, 0])
