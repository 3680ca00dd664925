"""A large part as tasks of a Dask cluster: each judges one cutter at one block of samples, on a ground that each worker keeps."""

import pickle
import secrets
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plan_cutters.batch.verdicts import made_by
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.verdicts import UNJUDGED, Verdicts
from plan_cutters.errors import PlanError
from plan_cutters.scene.ground import Ground
from plan_cutters.scene.preparation import Prepared
from plan_cutters.scene.threads import CHUNK
from plan_cutters.scene.work import Work
from plan_cutters.stages.judge import judge

#: Samples from which on a cluster judges: fewer take a second a cutter or less, about as long as to hand the ground out.
LARGE = 100_000
#: Tasks for each thread of the cluster, so that all of them end at about the same time, and the most samples of one.
_EACH, _MOST = 6, 32 * CHUNK
#: How often what was lost with its worker is handed out again, and after how many seconds; a task that ends worker after
#: worker is stopped by the scheduler.
_ROUNDS, _PAUSE = 5, 0.2
_AWAY = "the scheduler went away: start it, or leave --cluster out"
#: Before the parts that wait: whoever judges in rows is in the midst of a part.
_FIRST = 1
#: Grounds that a worker keeps unpacked, the last ones, by their tokens.
_CACHED = 2
_grounds: dict[str, Ground] = {}
_unpacking = threading.Lock()

#: First sample of a block, and the one after its last.
Block = tuple[int, int]


class DistributedJudge:
    """Judge as `stages.judge.judge` does, by the workers of a Dask cluster; the verdicts are the same, bit for bit.

    A block begins and ends with a piece of rows that are searched one after the other (`threads.CHUNK`), so that each sample has
    the neighbours that it has in a single run. The verdicts that follow from other cutters travel with the block.

    Parameters
    ----------
    client : distributed.Client
        It stays open.
    large : int, optional
        Samples from which on the cluster is used: below, this process judges.
    block : int, optional
        Samples of a task, rounded up to whole pieces. Default: as many as give each thread of the cluster some tasks.
    """

    def __init__(self, client: Any, *, large: int = LARGE, block: int | None = None) -> None:
        self._client, self._large, self._block = client, large, block
        self._of: tuple[Any, ...] = ()
        self._token, self._packed, self._there = "", b"", None

    def __call__(
        self,
        ready: Prepared,
        cutter: Cutter,
        rows: NDArray[np.int64] | None = None,
        known: Verdicts | None = None,
        *,
        progress: Callable[[int, int], None] | None = None,
        work: Work | None = None,
    ) -> Verdicts:
        """Find the verdicts of a cutter; parameters and result as of `judge`.

        Raises
        ------
        PlanError
            The cluster went away, its workers have another version of this program, or end again and again. What judging itself
            raises is raised here as it is.
        """
        n = len(ready.samples)
        if rows is not None or n < self._large:
            return judge(ready, cutter, rows, known, progress=progress, work=work)
        self._take(ready)
        blocks = list(self._blocks(n))
        results: dict[Block, tuple[Verdicts, int]] = {}
        for _ in range(_ROUNDS):
            missing = [each for each in blocks if each not in results]
            for block, judged in self._asked(missing, cutter, known):
                results[block] = judged
                if progress is not None:
                    progress(len(results), len(blocks))
            if len(results) == len(blocks):
                break
            # What the workers held of the ground is lost with them.
            self._there = None
            self._require_scheduler()
            time.sleep(_PAUSE)
        else:
            raise PlanError("the cluster loses its workers again and again: look into their logs; their memory may be too small")
        if work is not None:
            work.add(sum(looked for _, looked in results.values()))
        return _joined(results, n)

    def close(self) -> None:
        """Let the workers drop what they keep."""
        self._of, self._token, self._packed, self._there = (), "", b"", None

    def _take(self, ready: Prepared) -> None:
        """Pack the ground of a part and a setup, unless it is the one before: known by its arrays, not by what holds them."""
        of = Ground.made_of(ready)
        if Ground.same(of, self._of):
            return
        self._of, self._token, self._there = of, secrets.token_hex(8), None
        self._packed = pickle.dumps(Ground.of(ready), protocol=5)

    def _blocks(self, n: int) -> Iterator[Block]:
        size = self._block
        if size is None:
            try:
                threads = sum(self._client.nthreads().values())
            except OSError:
                raise PlanError(_AWAY) from None
            size = min(_MOST, -(-n // (_EACH * max(1, threads))))
        size = CHUNK * max(1, -(-size // CHUNK))
        return ((first, min(first + size, n)) for first in range(0, n, size))

    def _asked(self, blocks: list[Block], cutter: Cutter, known: Verdicts | None) -> Iterator[tuple[Block, tuple[Verdicts, int]]]:
        """What workers find at blocks, in the order in which it comes, without what is lost."""
        from dask import config
        from distributed import as_completed
        from distributed.scheduler import KilledWorker

        self._require_scheduler()
        if self._there is None:
            # A task of its own and not scattered: the scheduler makes it again when its workers are lost, and scattering hangs
            # when a worker ends meanwhile. Bytes: unpacked by each worker itself, arrays can be written, as kernels want them.
            with config.set({"distributed.admin.large-graph-warning-threshold": "1TB"}):
                self._there = self._client.submit(bytes, self._packed, key=f"ground-{secrets.token_hex(8)}", pure=False)
        token = secrets.token_hex(4)
        requests = {}
        try:
            for first, last in blocks:
                future = self._client.submit(
                    judged_block, self._token, self._there, first, last, cutter, _part(known, first, last), made_by(),
                    key=f"judge {cutter.id}-{token}-{first}", pure=False, priority=_FIRST,
                )  # fmt: skip
                requests[future] = first, last
            for future in as_completed(list(requests), loop=self._client.loop):
                if future.cancelled() or future.status == "lost":
                    continue
                try:
                    judged = future.result()
                except KilledWorker as error:
                    raise PlanError(
                        f"{cutter.id}: {error.allowed_failures + 1} workers ended at the same samples: look into "
                        "their logs; their memory may be too small"
                    ) from None
                if isinstance(judged, str):
                    raise PlanError(judged)
                yield requests.pop(future), judged
        finally:
            if requests:
                self._client.cancel(list(requests))

    def _require_scheduler(self) -> None:
        if self._client.status != "running":
            raise PlanError(_AWAY)


def judged_block(
    token: str, packed: bytes, first: int, last: int, cutter: Cutter, known: Verdicts | None, version: str
) -> tuple[Verdicts, int] | str:
    """Judge one cutter at a block of samples, on a worker.

    Parameters
    ----------
    token : str
        Of the ground: it is unpacked, and its trees are built, once a worker.
    packed : bytes
        The ground.
    first, last : int
        The block.
    cutter : Cutter
    known : Verdicts, optional
        What follows from other cutters, for the block alone.
    version : str
        Who asks (`made_by`).

    Returns
    -------
    Verdicts, int
        Of the block, and the work done. Or one line on why this worker must not judge.
    """
    if version != made_by():
        return f"a worker has another version ({made_by()}) than this program ({version}): install the same one on all machines"
    with _unpacking:
        if token not in _grounds:
            while len(_grounds) >= _CACHED:
                del _grounds[next(iter(_grounds))]
            ground: Ground = pickle.loads(packed)
            ground.conditions.surroundings.build(1)
            _grounds[token] = ground
        block = _grounds[token].block(first, last)
    work = Work()
    return judge(block, cutter, known=known, work=work), work.looked


def _part(known: Verdicts | None, first: int, last: int) -> Verdicts | None:
    """The part of known verdicts that is of a block; None where nothing is known there."""
    if known is None or (known.verdict[first:last] == UNJUDGED).all():
        return None
    return known.of(np.arange(first, last))


def _joined(results: Mapping[Block, tuple[Verdicts, int]], n: int) -> Verdicts:
    """The verdicts of all blocks, in the order of the samples."""
    parts = [results[block][0] for block in sorted(results)]
    whole = Verdicts(*(np.concatenate([getattr(part, each.name) for part in parts]) for each in fields(Verdicts)))
    if len(whole.verdict) != n:
        raise ValueError(f"workers judged {len(whole.verdict)} of {n} samples")
    return whole
