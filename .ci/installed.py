"""Build sdist and wheel, install the wheel in a clean environment, and plan a sample there, outside the checkout.

The clean environment holds the wheel and, as links, the files of just those distributions that the wheel declares (and theirs
in turn) in the versions of the development environment: what is imported and not declared is missing there. To load all of
them anew would take longer than everything else in `.ci/run`.
"""

import os
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import tempfile
import zipfile
from importlib.metadata import Distribution, distribution
from pathlib import Path

from packaging.requirements import Requirement

ROOT = Path(__file__).resolve().parent.parent
OURS = ("plan_cutters/", "cad_io/")


def main() -> None:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        # The wheel is made from the sdist, not from the checkout: so the sdist is complete for it.
        run(sys.executable, "-m", "build", "--no-isolation", "--outdir", folder, ROOT, cwd=folder, quiet=True)
        (wheel,), (sdist,) = folder.glob("*.whl"), folder.glob("*.tar.gz")
        same("sdist", in_sdist(sdist), tracked())
        same("wheel", in_wheel(wheel), {path.removeprefix("plugin/") for path in tracked() if packaged(path)})
        python = clean(folder / "clean", wheel)
        outside = folder / "outside"
        outside.mkdir()
        shutil.copy(ROOT / "samples/v_groove.step", outside)
        # No folder of the checkout is on the path; what was compiled before is found by the content of the sources.
        env = {key: value for key, value in os.environ.items() if not key.startswith("PYTHON")}
        where = "import plan_cutters, cad_io; print(plan_cutters.__file__, cad_io.__file__)"
        for path in run(python, "-c", where, cwd=outside, env=env).split():
            assert Path(path).is_relative_to(folder), f"{path} is not the installed one"
        command = python.parent / "plan-cutters"
        run(
            command,
            "v_groove.step",
            "--cutter",
            "R8L90",
            "--grid",
            "5",
            "--area-budget",
            "0",
            cwd=outside,
            env=env,
            quiet=True,
        )
        made = {path.name for path in (outside / "v_groove-plan").iterdir()}
        assert made == {"plan.json", "review.html", "annotated.step", "annotated.glb", "samples.npz"}, made
        run(command, "diff", "v_groove-plan", "v_groove-plan/plan.json", cwd=outside, env=env)
        print(f"{wheel.name}: {len(in_wheel(wheel))} files, planned a sample in a clean environment")


def run(*words: object, cwd: Path, env: dict[str, str] | None = None, quiet: bool = False) -> str:
    """Run a command; its standard output. What it says is shown if it fails."""
    done = subprocess.run([str(word) for word in words], cwd=cwd, env=env, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"{' '.join(str(word) for word in words)}\n{done.stdout}{done.stderr}")
    return "" if quiet else done.stdout


def tracked() -> set[str]:
    """Files that git tracks."""
    return set(filter(None, run("git", "ls-files", "-z", cwd=ROOT).split("\0")))


def packaged(path: str) -> bool:
    """Whether a tracked file belongs to a package."""
    return path.removeprefix("plugin/").startswith(OURS)


def in_wheel(wheel: Path) -> set[str]:
    """Files of the packages in a wheel."""
    return {name for name in zipfile.ZipFile(wheel).namelist() if name.startswith(OURS)}


def in_sdist(sdist: Path) -> set[str]:
    """Files of an sdist but those that setuptools adds."""
    with tarfile.open(sdist) as archive:
        names = {member.name.partition("/")[2] for member in archive if not member.isdir()}
    return {name for name in names if name not in ("PKG-INFO", "setup.cfg") and ".egg-info/" not in name}


def same(what: str, found: set[str], asked: set[str]) -> None:
    """End with the files that are missing from a distribution, or that it has beyond those that git tracks."""
    if found != asked:
        sys.exit(f"{what}: missing {sorted(asked - found)}, not tracked by git {sorted(found - asked)}")


def closure() -> dict[str, Distribution]:
    """Distributions that ours declares without extras, and theirs in turn, with the extras that each asks for."""
    found: dict[str, Distribution] = {}
    seen, left = set(), [("plan-cutters", frozenset[str]())]
    while left:
        name, extras = each = left.pop()
        if each in seen:
            continue
        seen.add(each)
        found[name] = distribution(name)
        for text in found[name].requires or ():
            need = Requirement(text)
            if need.marker is None or any(need.marker.evaluate({"extra": extra}) for extra in ("", *extras)):
                left.append((need.name.lower(), frozenset(need.extras)))
    del found["plan-cutters"]
    return found


def clean(folder: Path, wheel: Path) -> Path:
    """Make an environment with the wheel and, as links, what it declares; its Python."""
    run(sys.executable, "-m", "venv", folder, cwd=ROOT)
    python = folder / "bin" / "python"
    site = Path(run(python, "-c", "import sysconfig; print(sysconfig.get_paths()['purelib'])", cwd=folder).strip())
    ours = Path(sysconfig.get_paths()["purelib"])
    for each in closure().values():
        for top in {file.parts[0] for file in each.files or () if file.parts[0] not in ("..", "__pycache__")}:
            if (ours / top).exists() and not (site / top).exists():
                (site / top).symlink_to(ours / top)
    # Its own requirements must be met by what is there: `pip check` looks at their versions.
    run(python, "-m", "pip", "install", "--quiet", "--no-deps", "--no-index", wheel, cwd=folder)
    run(python, "-m", "pip", "check", cwd=folder)
    return python


if __name__ == "__main__":
    main()
