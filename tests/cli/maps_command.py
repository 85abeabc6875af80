"""Helpers that run `placecell maps` in this process."""

from typer.testing import CliRunner, Result

from cli import app


def run(*words: object) -> Result:
    result: Result = CliRunner().invoke(app, ["maps", *map(str, words)])
    return result


def good(*words: object) -> str:
    result = run(*words)
    assert result.exit_code == 0, result.output
    return result.output


def bad(*words: object) -> str:
    result = run(*words)
    assert result.exit_code == 1
    assert "Traceback" not in result.output
    return result.output
