#!/bin/bash
# make_root.sh STAGE ROOT: the file system of an image: what is installed in STAGE, every library that it links, the fonts of
# fonts-dejavu-core with fontconfig's configuration, and the folders that a program expects.
set -euo pipefail
stage=$1 root=$2
mkdir -p "$root"/{etc,tmp,work,usr/share/fonts/truetype,usr/share/fontconfig}
umask 022
chmod 1777 "$root/tmp"
for link in bin lib lib64; do
  mkdir -p "$root/usr/$link"
  ln -sfn "usr/$link" "$root/$link"
done
cp -a "$stage/." "$root/"
rm -f "$root"/usr/bin/openrt-replay # a copy of libopenrt, to look at recordings
rm -rf "$root"/usr/share/{man,applications,mime,icons,metainfo,bash-completion,zsh,fish}

# The libraries keep their places, so that the loader finds them without a cache.
libraries=$(find "$stage" -type f \( -perm -u+x -o -name '*.so*' \) -exec sh -c 'head -c4 "$1" | grep -q ELF' _ {} \; -print)
folders=$(find "$stage" -name 'lib*.so*' -printf '%h\n' | sort -u | paste -sd:)
for file in $libraries; do LD_LIBRARY_PATH=$folders ldd "$file"; done |
  sed -nE 's/.*=> (\/[^ ]+) .*/\1/p; s/^\s+(\/[^ ]+ld-linux[^ ]+) .*/\1/p' | grep -v "^$stage" | sort -u |
  while read -r library; do
    place=$(realpath -ms "/usr/${library#/usr/}")
    mkdir -p "$root$(dirname "$place")"
    cp -L "$library" "$root$place"
  done

cp -a --parents /etc/fonts "$root"
for folder in fonts/truetype/dejavu fontconfig/conf.avail; do
  if [ -d /usr/share/$folder ]; then cp -a /usr/share/$folder "$root/usr/share/${folder%/*}/"; fi
done
printf 'root:x:0:0::/:/\nuser:x:1000:1000::/work:/\n' >"$root/etc/passwd"
size=$(du -sb "$root" | cut -f1)
echo "$root: $size bytes"
[ "$size" -lt 100000000 ] || { echo "make_root: the image has more than 100 MB" >&2; exit 1; }
