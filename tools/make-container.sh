#!/bin/bash
# make-container.sh [OPTION...]: the image `openrt` (contrib/container), by podman, buildah or docker, whichever is installed; options
# are passed on (`--isolation=chroot --network=host` where containers cannot be nested).
set -euo pipefail
cd "$(dirname "$0")/.."
for tool in podman buildah docker; do
  command -v $tool >/dev/null || continue
  exec $tool build "$@" -f contrib/container/Containerfile -t openrt .
done
echo "make-container: podman, buildah or docker is needed" >&2
exit 1
