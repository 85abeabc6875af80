"""Run the command line: `python -m cli` is the same as `placecell`."""

from cli import app

app()
