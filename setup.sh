#!/bin/sh
# Make .venv and install plan-cutters into it, with CadQuery and build123d for scripts; `sh setup.sh dev` adds what the tests and
# linters need, `sh setup.sh alone` leaves the two hosts out, two thirds of all bytes.
# Packages of the system are installed only where one is missing, and only after a line that says which one and why.
set -eu
cd "$(dirname "$0")"

# outside WHY PACKAGE...: install Debian packages, the only step outside this folder.
outside() {
    why=$1
    shift
    if ! command -v apt-get >/dev/null; then
        echo "setup.sh: missing: $* ($why). Install them with the package manager of this system." >&2
        return 1
    fi
    sudo=""
    [ "$(id -u)" = 0 ] || sudo="sudo"
    echo "setup.sh: installing $* outside .venv, with $sudo apt-get: $why" >&2
    $sudo apt-get update -qq && $sudo apt-get install -y -qq --no-install-recommends "$@" >/dev/null
}

dev=""
case "$*" in
    "") extra="batch,cadquery,build123d" ;;
    dev) extra="dev" dev=yes ;;
    alone) extra="batch" ;;
    *) echo "setup.sh: unknown words $*: give dev or alone, or nothing" >&2 && exit 2 ;;
esac
late=""
if [ ! -x .venv/bin/python ]; then
    python3 -m venv .venv
    late=--no-compile
fi
# For the tests, into node_modules and page/node_modules: the Khronos validator of GLB files, and what the review page is built with.
# They come while Python's packages do.
if [ -n "$dev" ]; then
    { npm install --silent --no-audit --no-fund --no-package-lock && npm ci --prefix page --silent --no-audit --no-fund; } &
    node=$!
fi
.venv/bin/python -m pip install --quiet --disable-pip-version-check $late --editable ".[$extra]"
# Editors and type checkers do not run the import hook that pip installs for two roots: they read paths.
printf '%s\n' "$PWD/plugin" "$PWD" >"$(.venv/bin/python -c 'import sysconfig; print(sysconfig.get_path("purelib"))')/plan_cutters_sources.pth"
# Pip makes byte code on one core: in a new .venv all of them do, but not of tests of others, a fifth of it all. A file that is
# no Python of this version is no mistake of ours.
[ -z "$late" ] || .venv/bin/python -m compileall -qq -j 0 -x '/tests?/' .venv/lib/python3*/site-packages || true
if ! .venv/bin/python -c "import OCP" 2>/dev/null; then
    outside "the CAD kernel links libGL and libX11, although nothing is drawn" libgl1 libx11-6
    .venv/bin/python -c "import OCP"
fi
# Both flavours of the kernel install the same files, in any order: CadQuery needs those of the full one.
full=$(.venv/bin/python -m pip freeze --all --disable-pip-version-check | grep "^cadquery-ocp==" || true)
if [ -n "$full" ] && ! .venv/bin/python -c "import OCP.IVtkOCC" 2>/dev/null; then
    .venv/bin/python -m pip install --quiet --disable-pip-version-check --force-reinstall --no-deps "$full"
fi
if [ -n "$dev" ]; then
    wait "$node"
    if ! command -v chromium >/dev/null; then
        outside "the tests of the review page need a browser" chromium ||
            echo "setup.sh: no chromium could be installed: tests of the review page will be skipped" >&2
    fi
fi
