"""Build sdist and wheel, install the wheel as its users do, in clean environments, and plan a sample there, outside the checkout.

`uv tool install` loads what the wheel declares, and nothing else: what is imported and not declared is missing there. `pipx run`
then finds it in the cache of uv. Both leave nothing behind but that cache.
"""

import os
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import zipfile
from email import message_from_string
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
OURS = (*(f"{path.parent.name}/" for path in ROOT.glob("plugin/*/__init__.py")), "cad_io/")
#: What an environment with the wheel may take, MB, and who must not be in it (`docs/install.md`).
MOST_MB, NOT_THERE = 700, ("matplotlib", "cadquery", "build123d", "vtk", "casadi", "pandas", "dask")
#: What a package index shows.
SHOWN = ("Author", "Summary", "License-Expression", "Keywords", "Classifier", "Project-URL", "Requires-Python")


def main() -> None:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        # The wheel is made from the sdist, not from the checkout: so the sdist is complete for it.
        run(sys.executable, "-m", "build", "--no-isolation", "--outdir", folder, ROOT, cwd=folder, quiet=True)
        (wheel,), (sdist,) = folder.glob("*.whl"), folder.glob("*.tar.gz")
        same("sdist", in_sdist(sdist), tracked())
        same("wheel", in_wheel(wheel), {path.removeprefix("plugin/") for path in tracked() if packaged(path)})
        shown(wheel)
        run(sys.executable, "-m", "twine", "check", "--strict", wheel, sdist, cwd=folder)
        outside = folder / "outside"
        outside.mkdir()
        shutil.copy(ROOT / "samples/v_groove.step", outside)
        env = own(folder)
        run(tool("uv"), "tool", "install", "--quiet", "--python", sys.executable, wheel, cwd=outside, env=env)
        python = folder / "tools" / "plan-cutters" / "bin" / "python"
        run(tool("uv"), "pip", "check", "--quiet", "--python", python, cwd=outside, env=env)
        megabytes = small(python.parent.parent)
        where = "import plan_cutters, cad_io; print(plan_cutters.__file__, cad_io.__file__)"
        for path in run(python, "-c", where, cwd=outside, env=env).split():
            assert Path(path).is_relative_to(folder), f"{path} is not the installed one"
        command = folder / "bin" / "plan-cutters"
        words = ["--cutter", "R8L90", "--grid", "5", "--area-budget", "0"]
        run(command, "v_groove.step", *words, cwd=outside, env=env)
        made = {path.name for path in (outside / "v_groove-plan").iterdir()}
        models = {"annotated.step", "annotated.glb"}
        assert made == {"plan.json", "process.toml", "review.html", "samples.npz", *models}, made
        run(command, "diff", "v_groove-plan", "v_groove-plan/plan.json", cwd=outside, env=env)
        said = run(tool("pipx"), "run", "--spec", wheel, "plan-cutters", "--version", cwd=outside, env=env)
        assert wheel.name.split("-")[1] in said, said
        print(f"{wheel.name}: {len(in_wheel(wheel))} files, planned a sample in an environment of {megabytes} MB")


def own(folder: Path) -> dict[str, str]:
    """The environment variables of a user: no folder of the checkout is on the path, and tools are installed below `folder`."""
    inherited = {key: value for key, value in os.environ.items() if not key.startswith(("PYTHON", "UV_TOOL", "PIPX_"))}
    places = {"UV_TOOL_DIR": "tools", "UV_TOOL_BIN_DIR": "bin", "PIPX_HOME": "pipx", "PIPX_BIN_DIR": "pipx-bin"}
    return {
        **inherited,
        **{key: str(folder / place) for key, place in places.items()},
        "PIPX_DEFAULT_BACKEND": "uv",
        "PATH": os.pathsep.join([str(Path(sys.executable).parent), inherited.get("PATH", "")]),
    }


def tool(name: str) -> Path:
    """A command of the development environment."""
    return Path(sys.executable).parent / name


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


def shown(wheel: Path) -> None:
    """End where a field is empty that a package index shows."""
    with zipfile.ZipFile(wheel) as archive:
        (path,) = (name for name in archive.namelist() if name.endswith(".dist-info/METADATA"))
        about = message_from_string(archive.read(path).decode())
    if empty := [field for field in SHOWN if not about[field]]:
        sys.exit(f"wheel: the metadata lack {empty}")
    if relative := re.findall(r"\]\((?![a-z]+:|#)[^)]*\)", str(about.get_payload())):
        sys.exit(f"wheel: links of the long description lead to no address: {relative}")
    if about["Author"] != "the plan-cutters developers":
        sys.exit(f"wheel: the author is {about['Author']}")


def small(environment: Path) -> int:
    """Size of an environment, MB; end where it is too large, or has what nobody needs."""
    (packages,) = environment.glob("lib/python3*/site-packages")
    if there := [name for name in NOT_THERE if (packages / name).exists()]:
        sys.exit(f"{there}: what was not requested was installed")
    size = sum(path.stat().st_size for path in environment.rglob("*") if path.is_file() and not path.is_symlink())
    megabytes = round(size / 1e6)
    if megabytes > MOST_MB:
        sys.exit(f"the environment has {megabytes} MB, {MOST_MB} were to be enough")
    return megabytes


if __name__ == "__main__":
    main()
