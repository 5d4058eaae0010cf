#!/bin/bash
# make-container.sh [OPTION...]: builds the image `openrt` (contrib/container) with podman, buildah
# or docker, whichever is installed. Options are passed on (`--isolation=chroot --network=host` if
# containers cannot be nested).
set -euo pipefail
cd "$(dirname "$0")/.."
for tool in podman buildah docker; do
  command -v $tool >/dev/null || continue
  exec $tool build "$@" -f contrib/container/Containerfile -t openrt .
done
echo "make-container: podman, buildah or docker is needed" >&2
exit 1
