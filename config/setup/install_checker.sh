#!/usr/bin/env bash
# install_checker.sh NAME...: installs each checker of exports, pinned in config/setup/NAME, into build/NAME. Only tests use them, and do without.
# Needs npm; says so where there is none.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
for name in "$@"; do
  target="$here/../../build/$name"
  if ! command -v npm >/dev/null; then
    echo "== $name: no npm here; the tests that need it SKIP"
    continue
  fi
  # npm writes the second file last, and would begin by throwing away what is there.
  if cmp -s "$here/$name/package-lock.json" "$target/package-lock.json" && [ -e "$target/node_modules/.package-lock.json" ]; then continue; fi
  mkdir -p "$target"
  cp "$here/$name/package.json" "$here/$name/package-lock.json" "$target/"
  # The peer of MaterialX's package, three, is for drawing in a browser.
  npm ci --silent --omit=peer --prefix "$target" || echo "== $name: npm cannot install it; the tests that need it SKIP"
done
