"""Backups of a store in a folder or a bucket, and moves of all maps between stores."""
