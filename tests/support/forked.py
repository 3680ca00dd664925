"""Commands in a fork of the tests' own process: a process of their own, without the seconds that an interpreter takes to start.

A copy of this process, which has imported the CAD kernel and the compiler, runs the command's `main` with streams, folder,
environment and signals of its own; the worker that the command starts is a fork, too. Tests that are about the start of a
process, about signals to it or about what it imports start a real one.
"""

import faulthandler
import functools
import importlib
import multiprocessing
import os
import select
import signal
import subprocess
import sys
import tempfile
import time
import traceback
import warnings
from pathlib import Path
from types import SimpleNamespace

from plan_cutters.command import entry
from tests.support.places import PACKAGES, ROOT

ENV = {**os.environ, "PYTHONPATH": f"{ROOT / 'plugin'}{os.pathsep}{ROOT}"}


def run(*words, cwd=None, command="plan-cutters", environment=None, bare=False, data=b"", timeout=240):
    """Run a command with its words: the `subprocess.CompletedProcess` that a process of its own would give.

    `bare`: what imports the CAD kernel or the compiler, or starts a process, fails. `data`: what its standard input holds.
    """
    if not bare:
        _warm(command)
    words = [str(word) for word in words]
    assert bare or words[:1] != ["batch"], "dask's loop does not outlive a fork: start a real process"
    with tempfile.TemporaryDirectory() as folder:
        streams = [os.path.join(folder, name) for name in ("in", "out", "err")]
        for path, held in zip(streams, (data, b"", b""), strict=True):
            Path(path).write_bytes(held)
        if not data:
            streams[0] = os.devnull
        asked = (command, words, cwd or os.getcwd(), ENV if environment is None else environment, streams)
        if bare:
            code = _bare().run(asked, timeout)
        else:
            copy = _copied(lambda: _command(*asked))
            try:
                code = copy.wait(timeout)
            finally:
                if copy.poll() is None:
                    os.kill(copy.pid, signal.SIGKILL)
        said = [Path(path).read_bytes().decode(errors="backslashreplace").replace("\r\n", "\n") for path in streams[1:]]
    return subprocess.CompletedProcess([command, *words], code, *said)


def start(*words, cwd, out=os.devnull, err=None, ignored=(), environment=None):
    """Begin `plan-cutters` with its words: a copy of this process that runs, with the text stream of its standard error.

    `out`, `err`: descriptors or files in place of standard output and standard error. `ignored`: signals that it is to pass over.
    """
    _warm("plan-cutters")
    here, there = os.pipe() if err is None else (None, err)
    words = [str(word) for word in words]
    streams = (os.devnull, out, there)
    copy = _copied(lambda: _command("plan-cutters", words, cwd, ENV if environment is None else environment, streams, ignored))
    if err is None:
        os.close(there)
        copy.stderr = os.fdopen(here, encoding="utf-8", errors="backslashreplace")
    return copy


@functools.cache
def _warm(command):
    """Import what the command imports, and load its machine code, once for all copies."""
    entry.module_of(command)
    if command in ("plan-cutters", "plan-cutters-map"):
        from plan_cutters import plan

        with tempfile.TemporaryDirectory() as folder:
            found = plan(ROOT / "samples/v_groove.step", cutters=["R6L80"], grid=5, posture_maps=True)
            found.write(folder)


class _Bare:
    """A copy of this process without what of ours it had imported, in which the kernel and the compiler cannot be imported and
    no process can be started. It has imported anew what the words of a command need, and is copied for each command."""

    def __init__(self):
        self._asks, answers = multiprocessing.Pipe()
        self._copy = _copied(lambda: self._serve(answers))
        answers.close()

    def run(self, asked, timeout):
        self._asks.send(asked)
        if not self._asks.poll(timeout):
            os.kill(self._copy.pid, signal.SIGKILL)
            _bare.cache_clear()
            raise subprocess.TimeoutExpired(asked[1], timeout)
        return self._asks.recv()

    def _serve(self, answers):
        self._asks.close()
        for number in (0, 1):
            os.dup2(os.open(os.devnull, os.O_RDWR), number)
        sys.stdout = sys.stderr = None
        for name in [n for n in sys.modules if n.partition(".")[0] in (*PACKAGES, "OCP", "numba")]:
            del sys.modules[name]
        sys.modules["OCP"] = sys.modules["numba"] = subprocess.Popen = None
        importlib.import_module("plan_cutters_base.workers.child").begin_early = lambda words: None
        importlib.import_module("plan_cutters.command.entry").module_of("plan-cutters")
        while True:
            try:
                asked = answers.recv()
            except EOFError:  # the process of the tests has ended
                return
            answers.send(_copied(functools.partial(_command, *asked, bare=True)).wait())


_bare = functools.cache(_Bare)


def _copied(work):
    """A copy of this process that does some work and ends."""
    pid = os.fork()
    if pid == 0:
        _live(work)
    return _Copy(pid)


def _live(work):
    """Work in a copy of this process and end it, whatever happens: no test may go on in the copy."""
    code = 99
    try:
        work()
        code = 0
    except SystemExit as ended:
        code = ended.code if isinstance(ended.code, int) else int(ended.code is not None)
    except KeyboardInterrupt:
        code = 130
    except BaseException:
        os.write(2, traceback.format_exc().encode())
    finally:
        try:
            for stream in (sys.stdout, sys.stderr):
                if stream is not None:
                    stream.flush()
        finally:
            os._exit(code)


def _command(command, words, cwd, environment, streams, ignored=(), bare=False):
    for number, stream in enumerate(streams):
        os.dup2(os.open(stream, os.O_RDWR) if isinstance(stream, str) else stream, number)
    sys.stdin, sys.stdout = os.fdopen(0), os.fdopen(1, "w", encoding="utf-8")
    sys.stderr = os.fdopen(2, "w", encoding="utf-8", errors="backslashreplace")
    os.environ.clear()
    os.environ.update(environment)
    os.chdir(cwd)
    faulthandler.disable()
    warnings.resetwarnings()
    for each in (DeprecationWarning, PendingDeprecationWarning, ImportWarning, ResourceWarning):
        warnings.simplefilter("ignore", each)
    for number in (signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_DFL)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    for number in ignored:
        signal.signal(number, signal.SIG_IGN)
    sys.argv = [command, *words]
    if not bare:
        child = importlib.import_module("plan_cutters_base.workers.child")
        child.subprocess = SimpleNamespace(**{**vars(subprocess), "Popen": _worker})
    vars(importlib.import_module("plan_cutters.command.entry"))[_ENTRIES[command]]()


_ENTRIES = {
    "plan-cutters": "plan_cutters",
    "plan-cutters-tools": "tools",
    "plan-cutters-machines": "machines",
    "plan-cutters-map": "point_map",
}


def _worker(words, *, env, start_new_session, pass_fds):
    """Start the command's worker: a copy of this process in place of a new interpreter that calls the same entry."""
    python, *option, run, words = (*words[:4], words[4:])
    name = run.partition("'")[2].rpartition("'")[0]
    assert (python, *option) == (sys.executable, "-P", "-c"), "the worker is started in another way: copy that"
    assert run == f"from plan_cutters.command.entry import begin; begin({name!r})"

    def work():
        if start_new_session:
            os.setsid()
        # Who waits for the end of a pipe must not wait for this copy.
        first = 3
        for number in sorted(pass_fds):
            os.closerange(first, number)
            first = number + 1
        os.closerange(first, 1 << 12)
        for number in (signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, signal.SIG_DFL)
        os.environ.clear()
        os.environ.update(env)
        sys.argv = [name, *words]
        entry.begin(name)

    return _copied(work)


class _Copy:
    """A copy of this process, with what of `subprocess.Popen` is used here and in `supervise`."""

    def __init__(self, pid):
        self.pid, self.returncode, self.stderr = pid, None, None

    def poll(self):
        if self.returncode is None:
            pid, status = os.waitpid(self.pid, os.WNOHANG)
            if pid:
                self.returncode = os.waitstatus_to_exitcode(status)
        return self.returncode

    def wait(self, timeout=None):
        ends = time.monotonic() + (timeout if timeout is not None else 1e9)
        while self.poll() is None:
            if time.monotonic() > ends:
                raise subprocess.TimeoutExpired("a copy of the tests' process", timeout)
            select.select([], [], [], 0.005)
        return self.returncode

    def communicate(self, timeout=None):
        """What else is said on standard error until it ends, behind nothing of standard output."""
        with self.stderr:
            rest = self.stderr.read()
        self.wait(timeout)
        return None, rest

    def send_signal(self, number):
        if self.poll() is None:
            os.kill(self.pid, number)
