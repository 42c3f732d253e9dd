#!/usr/bin/env bash
# From a bare Debian 12 to a report: installs what is missing, builds, photographs an object on the simulated rig, fits it
# and leaves a page to look at. Safe to run again; finished steps are kept.
#
#   rig/quickstart.sh [FOLDER]      FOLDER: where the session, the model and the report go (default: out)
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
out=${1:-$root/out}
mkdir -p "$out"
out=$(cd "$out" && pwd)
cd "$root"

config/setup/build.sh
lumitexel=$root/build/release/rig/console/lumitexel

if [ -d "$out/session" ]; then
  echo "== capture: going on with $out/session"
  "$lumitexel" resume "$out/session"
else
  echo "== capture: photographing the object on the simulated rig"
  "$lumitexel" capture config/rigs/simulated.toml config/plans/first_light.toml --out "$out/session"
fi
echo "== verify: every byte against its hash"
"$lumitexel" verify "$out/session"
echo "== calibrate: darks, HDR, light positions, scale"
"$lumitexel" calibrate "$out/session"
echo "== fit: materials and texels"
"$lumitexel" fit "$out/session" --out "$out/model"
echo "== report"
"$lumitexel" report "$out/model" --session "$out/session" --out "$out/report.html"
echo "== done in $SECONDS s: open $out/report.html"
