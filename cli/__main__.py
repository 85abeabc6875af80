"""`python -m cli`: the same as `placecell`."""

from cli import app

app()
