#!/usr/bin/env bash
# Installs what is missing and builds everything with the `release` preset. Safe to run again.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
cd "$root"
config/setup/install_packages.sh
echo "== build: configuring (preset release)"
cmake --preset release >build-configure.log || { cat build-configure.log; exit 1; }
rm -f build-configure.log
echo "== build: compiling with $(nproc) cores"
started=$SECONDS
cmake --build --preset release -- --quiet
echo "== build: done in $((SECONDS - started)) s"
