"""The systems to compare with: other ways from a LiDAR's local map to its pose in a map.

    make peers
    placecell bench peers MAP_DRIVE QUERY_DRIVE --json peers.json

Each peer runs in a process of its own, in the environment of `requirements.txt`, and sees the very
local maps that our segments are cut from. What it is given and what it answers are files
(`exchange.py`), so that its packages and ours never meet.
"""
