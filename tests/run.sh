#!/usr/bin/env bash
# Sets the machine up, builds, and runs every test. Safe to run again; ctest closes the run.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
cd "$root"
config/setup/build.sh
config/setup/install_checker.sh gltf_validator materialx_library
[ -d "${LUMITEXEL_SHARED_DATA:-../shared/data}" ] ||
  echo "== tests: ../shared/data is not there (set LUMITEXEL_SHARED_DATA); tests that need it SKIP, and say so"
echo "== tests"
ctest --preset release -j "$(($(nproc) + 1))"  # one more: some wait for devices
