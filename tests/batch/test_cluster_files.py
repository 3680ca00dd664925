"""The files for SLURM and Kubernetes: they name options that there are, and the script plans parts where `srun` is a stand-in."""

import os
import re
import shlex
import shutil
import subprocess
from pathlib import Path

import pytest

from plan_cutters_batch import command as batch
from tests.support.forked import ENV
from tests.support.places import ROOT

yaml = pytest.importorskip("yaml")
HERE = ROOT / "docs/clusters"
SCRIPT = (HERE / "plan-cutters.sbatch").read_text()
#: Of sbatch, each with what its value looks like.
SBATCH = {
    "job-name": r"\S+",
    "ntasks": r"\d+",
    "cpus-per-task": "1",
    "mem-per-cpu": r"\d+G",
    "time": r"\d\d:\d\d:\d\d",
    "output": r"\S+",
}
OPTIONS = {word for param in batch.command.params for word in param.opts if word.startswith("--")}


def options_of_dask(kind):
    module = pytest.importorskip(f"distributed.cli.dask_{kind}")
    return {word for param in module.main.params for word in (*param.opts, *param.secondary_opts)}


def used(words):
    return {word.partition("=")[0] for word in words if word.startswith("--")}


@pytest.fixture(scope="module")
def documents():
    return list(yaml.safe_load_all((HERE / "kubernetes.yaml").read_text()))


def commands():
    """The commands of the script, each as its words."""
    text = re.sub(r"\\\n\s*", " ", SCRIPT)
    return [shlex.split(line.rstrip("&")) for line in text.splitlines() if re.match(r"\s*(srun|dask|plan-cutters) ", line)]


def test_the_script_is_one_of_bash_with_words_of_sbatch():
    done = subprocess.run(["bash", "-n", HERE / "plan-cutters.sbatch"], capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    assert SCRIPT.startswith("#!/bin/bash\n")
    asked = dict(re.findall(r"^#SBATCH --([\w-]+)=(\S+)$", SCRIPT, re.MULTILINE))
    assert len(asked) == SCRIPT.count("\n#SBATCH")
    assert all(re.fullmatch(SBATCH[word], value) for word, value in asked.items())
    # sbatch reads no more of these after the first command.
    assert "#SBATCH" not in SCRIPT.partition("set -euo")[2]


def test_all_options_of_the_script_exist():
    kinds = {"dask scheduler": options_of_dask("scheduler"), "dask worker": options_of_dask("worker")}
    for words in commands():
        if "plan-cutters" in words:
            assert used(words) <= OPTIONS
        else:
            at = words.index("dask")
            assert used(words[at:]) <= kinds[" ".join(words[at : at + 2])]
            assert used(words[:at]) <= {"--ntasks", "--exact"}
    assert len(commands()) == 3


def test_the_manifest_names_what_it_has(documents):
    by_kind = {(each["kind"], each["metadata"]["name"]): each for each in documents}
    service = by_kind["Service", "plan-cutters-scheduler"]
    pods = {name: each["spec"]["template"] for (kind, name), each in by_kind.items() if kind in ("Deployment", "Job")}
    for (kind, name), each in by_kind.items():
        if kind == "Deployment":
            assert each["spec"]["selector"]["matchLabels"] == pods[name]["metadata"]["labels"]
    chosen = [name for name, pod in pods.items() if pod["metadata"]["labels"] == service["spec"]["selector"]]
    assert chosen == ["plan-cutters-scheduler"]
    port = service["spec"]["ports"][0]["port"]
    for name, pod in pods.items():
        (container,) = pod["spec"]["containers"]
        words = [*container.get("command", []), *container.get("args", [])]
        assert all(isinstance(word, str) for word in words)
        for word in words:
            if word.startswith("tcp://"):
                assert word == f"tcp://{service['metadata']['name']}:{port}"
        kind = "dask" if words[0] == "dask" else words[0]
        assert used(words) <= (options_of_dask(words[1]) if kind == "dask" else OPTIONS), name
        volumes = {each["name"] for each in pod["spec"].get("volumes", [])}
        assert {each["name"] for each in container.get("volumeMounts", [])} == volumes


@pytest.mark.slow("starts a cluster")
def test_the_script_plans_parts_where_srun_is_a_stand_in(tmp_path):
    """`srun` begins as many processes on this machine; all else is as on a cluster."""
    tools = tmp_path / "venv/bin"
    tools.mkdir(parents=True)
    (tools / "activate").write_text(f'export PATH="{tools}:$PATH"\n')
    python = shutil.which("python3", path=f"{ROOT / '.venv/bin'}{os.pathsep}{os.environ['PATH']}")
    for name, module in (("dask", "dask"), ("plan-cutters", "plan_cutters")):
        (tools / name).write_text(f'#!/bin/sh\nexec "{python}" -P -m {module} "$@"\n')
    (tools / "srun").write_text('#!/bin/bash\nn="${1#--ntasks=}"; shift 2\nfor _ in $(seq "$n"); do "$@" & done; wait\n')
    for each in tools.iterdir():
        each.chmod(0o755)
    (tmp_path / "parts").mkdir()
    for name in "ab":
        Path(tmp_path, "parts", f"{name}.step").write_bytes(
            (ROOT / "samples/v_groove.step").read_bytes() + f"/* {name} */\n".encode()
        )
    script = SCRIPT.replace("/net/shop", str(tmp_path)).replace(
        '--cutters "$shop/shop.tools"', "--cutter R6L80 --grid 5 --formats json"
    )
    (tmp_path / "job").write_text(script)
    (tmp_path / "tmp").mkdir()
    slurm = {"SLURM_JOB_ID": "7", "SLURM_NTASKS": "3", "TMPDIR": str(tmp_path / "tmp")}
    done = subprocess.run(["bash", "job"], cwd=tmp_path, env={**ENV, **slurm}, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    assert "2 parts: 2 finished." in done.stdout
    assert (tmp_path / "plans/index.html").is_file()
    assert not (tmp_path / "scheduler-7.json").exists()
