#!/bin/sh
# Make .venv and install plan-cutters into it, with CadQuery and build123d for scripts, clusters and pictures; `sh setup.sh dev` adds
# what the tests and linters need, `sh setup.sh alone` leaves the two hosts out, two thirds of all bytes.
# Packages of the system are installed only where one is missing, and only after a line that says which one and why.
set -eu
cd "$(dirname "$0")"

say() {
    echo "setup.sh: $*" >&2
}

# outside WHY PACKAGE...: install Debian packages, the only step outside this folder.
outside() {
    why=$1
    shift
    if ! command -v apt-get >/dev/null; then
        say "missing: $* ($why). Install them with the package manager of this system."
        return 1
    fi
    sudo=""
    [ "$(id -u)" = 0 ] || sudo="sudo"
    say "installing $* outside .venv, with $sudo apt-get: $why"
    $sudo apt-get update -qq && $sudo apt-get install -y -qq --no-install-recommends "$@" >/dev/null
}

dev="" hosts=yes all="batch,build123d,cadquery,conformance,mcp,pictures" group=""
case "$*" in
    "") extra="batch,build123d,cadquery,conformance,pictures" what="plan-cutters with CadQuery and build123d, 2.2 GB" ;;
    dev) extra="$all" dev=yes group="--group dev" what="plan-cutters with all that tests and linters need, 2.8 GB" ;;
    alone) extra="batch,pictures" hosts="" what="plan-cutters alone, 0.8 GB" ;;
    *) say "unknown words $*: give dev or alone, or nothing" && exit 2 ;;
esac
python=.venv/bin/python
if [ ! -x $python ]; then
    say "making .venv"
    python3 -m venv .venv
fi
# For the tests, into node_modules and page/node_modules: the Khronos validator of GLB files, and what the review page is built with.
# They come while Python's packages do.
if [ -n "$dev" ]; then
    { npm install --silent --no-audit --no-fund --no-package-lock && npm ci --prefix page --silent --no-audit --no-fund; } &
    node=$!
fi
# uv loads packages side by side, and writes no byte code: Python makes that of what runs, when it first runs.
if [ ! -x .venv/bin/uv ]; then
    say "installing uv, which installs the rest"
    $python -m pip install --quiet --disable-pip-version-check --no-compile "uv>=0.8"
fi
# uv does not read what pip was told about the place that packages come from.
index=$($python -m pip config get global.index-url 2>/dev/null || true)
[ -z "$index" ] || export UV_DEFAULT_INDEX="${UV_DEFAULT_INDEX:-$index}"
uv() {
    command=$1
    shift
    .venv/bin/uv pip "$command" --quiet --python $python "$@"
}
# Two flavours of the kernel have the same files. CadQuery needs the one with a bridge to VTK: beside it the other is left out.
: >.venv/overrides.txt
again=""
if [ -n "$hosts" ]; then
    echo "cadquery-ocp-novtk; sys_platform == 'never'" >.venv/overrides.txt
    if uv show cadquery-ocp-novtk >/dev/null 2>&1; then
        uv uninstall cadquery-ocp-novtk
        again="--reinstall-package cadquery-ocp"
    fi
fi
say "installing $what"
uv install $again $group --overrides .venv/overrides.txt --editable ".[$extra]"
# Editors and type checkers do not run the import hook that an editable install has for two roots: they read paths.
printf '%s\n' "$PWD/plugin" "$PWD" >"$($python -c 'import sysconfig; print(sysconfig.get_path("purelib"))')/plan_cutters_sources.pth"
if ! $python -c "import OCP" 2>/dev/null; then
    outside "the CAD kernel links libGL and libX11, although nothing is drawn" libgl1 libx11-6
    $python -c "import OCP"
fi
# Written last, the smaller flavour has taken the place of the full one that CadQuery needs.
full=$(.venv/bin/uv pip freeze --quiet --python $python | grep "^cadquery-ocp==" || true)
if [ -n "$full" ] && ! $python -c "from OCP.IVtkOCC import IVtkOCC_Shape" 2>/dev/null; then
    uv install --no-deps --reinstall-package cadquery-ocp "$full"
fi
if [ -n "$dev" ]; then
    say "waiting for the packages of the page"
    wait "$node"
    if ! command -v chromium >/dev/null; then
        outside "the tests of the review page need a browser" chromium ||
            say "no chromium could be installed: tests of the review page will be skipped"
    fi
fi
