#!/bin/sh
# Make .venv and install plan-cutters into it; `sh setup.sh dev` adds what the tests and linters need.
# The CAD kernel links libGL and libX11 although nothing is drawn: where they are missing, Debian's packages are
# installed (this is the one step outside .venv).
set -eu
cd "$(dirname "$0")"
[ -x .venv/bin/python ] || python3 -m venv .venv
extra=""
[ "${1:-}" = dev ] && extra="[dev]"
.venv/bin/python -m pip install --quiet --disable-pip-version-check --editable ".$extra"
if ! .venv/bin/python -c "import OCP" 2>/dev/null; then
    sudo=""
    [ "$(id -u)" = 0 ] || sudo="sudo"
    $sudo apt-get update -qq
    $sudo apt-get install -y -qq --no-install-recommends libgl1 libx11-6 >/dev/null
    .venv/bin/python -c "import OCP"
fi
# For the tests: the Khronos validator of GLB files, what the review page is built and checked with, and a browser.
if [ "${1:-}" = dev ]; then
    npm install --silent --no-audit --no-fund --no-package-lock
    npm ci --prefix page --silent --no-audit --no-fund
    if ! command -v chromium >/dev/null; then
        sudo=""
        [ "$(id -u)" = 0 ] || sudo="sudo"
        $sudo apt-get update -qq
        $sudo apt-get install -y -qq --no-install-recommends chromium >/dev/null ||
            echo "no chromium could be installed: tests of the review page will be skipped" >&2
    fi
fi
