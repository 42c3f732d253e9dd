#!/usr/bin/env bash
# Installs Khronos' glTF validator, pinned, into build/gltf_validator. Only tests use it, and do without. Needs npm; says so where there is none.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
target="$here/../../build/gltf_validator"
if ! command -v npm >/dev/null; then
  echo "== glTF validator: no npm here; the test that needs it SKIPs"
  exit 0
fi
mkdir -p "$target"
cp "$here/gltf_validator/package.json" "$here/gltf_validator/package-lock.json" "$target/"
npm ci --silent --prefix "$target" || echo "== glTF validator: npm cannot install it; the test that needs it SKIPs"
