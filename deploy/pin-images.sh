#!/bin/sh
# Pin the images of the Dockerfile and of deploy/ by digest: asks the registry what each tag is now,
# and writes TAG@sha256:... in its place. Run it again to take up a newer build of the same tag.
# It needs docker with buildx. Images of Placecell itself are left as they are.
set -eu
cd "$(dirname "$0")/.."
files="Dockerfile deploy/compose.yaml deploy/kubernetes.yaml deploy/fleet/compose.yaml
    deploy/fleet/kubernetes.yaml"
images=$(sed -nE 's/^(FROM| *image:) +([^ @]+).*/\2/p' $files | grep -v '^placecell:' | sort -u)
for image in $images; do
    digest=$(docker buildx imagetools inspect --format '{{.Manifest.Digest}}' "$image")
    case $digest in
        sha256:*) ;;
        *) echo "pin-images: no digest of $image: $digest" >&2; exit 1 ;;
    esac
    for file in $files; do
        sed -E "s|($image)(@sha256:[0-9a-f]+)?( \|$)|\1@$digest\3|" "$file" > "$file.pinned"
        cat "$file.pinned" > "$file"
        rm "$file.pinned"
    done
    echo "$image@$digest"
done
