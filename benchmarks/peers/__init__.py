"""Peers: other systems that find the pose of a LiDAR's local map in a map.

    make peers
    placecell bench peers MAP_DRIVE QUERY_DRIVE --json peers.json

Each peer gets the same local maps that our segmentation gets. It runs in its own process, in the
environment of `requirements.txt`. Its input and its answers are files (`exchange.py`), so its
packages and ours are never loaded together.
"""
