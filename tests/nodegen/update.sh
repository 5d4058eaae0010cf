#!/bin/sh
# usage: tests/nodegen/update.sh NODEGEN: rewrites tests/nodegen/expected. Read the differences before you commit them.
set -eu
cd "$(dirname "$0")"
for name in tiny roles x3d; do
  out=$(mktemp -d)
  "$1" --output "$out" --reference "$out/nodes.md" --stub "$out/nodes.pyi" "$name.node"
  mkdir -p "expected/$name"
  for file in xvrml/nodes.h xvrml/node_renderer.h "nodes_$name.cpp" nodes_list.cpp nodes_renderer.cpp nodes.md nodes.pyi; do
    cp "$out/$file" "expected/$name/$(basename "$file").expected"
  done
  rm -r "$out"
done
out=$(mktemp -d)
"$1" tiny.node --skeleton Everything --skeleton-file "$out/skeleton.cpp"
cp "$out/skeleton.cpp" expected/tiny/skeleton.cpp.expected
rm -r "$out"
