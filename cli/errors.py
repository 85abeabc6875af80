"""Errors of the command line: turns exceptions into messages and exit statuses."""

import codecs
import errno
import json
import os
import re
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any, NoReturn

import typer
from typer.core import TyperGroup

DEBUG_VARIABLE = "PLACECELL_DEBUG"
"""Environment variable; if it is set, errors show their stack trace."""

FAILED, INTERRUPTED, PIPE_CLOSED = 1, 130, 141
"""Exit statuses. The last two are 128 plus the signal's number, as in shells."""


def fail(message: object, status: int = FAILED) -> NoReturn:
    """End the command with a message on standard error."""
    line = "; ".join(part.strip() for part in str(message).splitlines() if part.strip())
    typer.secho(f"placecell: {line}", err=True, fg=typer.colors.RED)
    raise typer.Exit(status)


@contextmanager
def clear_errors() -> Iterator[None]:
    """Show errors that the user can fix as one line, without a stack trace."""
    try:
        yield
    except BrokenPipeError:
        raise  # The reader of the output has closed the pipe; no message is needed.
    except ModuleNotFoundError as error:
        if os.environ.get(DEBUG_VARIABLE):
            raise
        fail(f"The Python package {error.name} is not installed. Run 'make install'.")
    except (ValueError, OSError) as error:
        if os.environ.get(DEBUG_VARIABLE):
            raise
        fail(plain(error))


def plain(error: BaseException) -> str:
    """Return an error as one line: the file or setting, the fault, the remedy."""
    if isinstance(error, OSError):
        return _plain_os_error(error)
    if isinstance(error, UnicodeError):
        return f"text has the wrong encoding ({error})"
    if isinstance(error, json.JSONDecodeError):
        return f"not valid JSON ({error})"
    if isinstance(error, MemoryError):
        return "out of memory"
    errors = getattr(error, "errors", None)
    if callable(errors) and isinstance(error, ValueError):  # pydantic's, without its address
        return "; ".join(_plain_fault(one) for one in errors())
    return _plain_variable(str(error)) or type(error).__name__


def _plain_variable(message: str) -> str:
    """Name the environment variable whose value pydantic-settings cannot parse."""
    unparsed = re.match(r'error parsing value for field "(\w+)"', message)
    if unparsed is None:
        return message
    variable = f"PLACECELL_{unparsed[1].upper()}"
    found = os.environ.get(variable, "")
    return f"{variable}: found {found!r:.80}, expected JSON, such as '[\"group\"]' for a list"


def _plain_fault(fault: dict[str, Any]) -> str:
    """Format a fault that pydantic found as NAME: found VALUE, expected RULE."""
    message = fault["msg"].removeprefix("Value error, ").partition(", unable to parse")[0]
    rule = message.removeprefix("Input should be ")
    rule = rule.replace("greater than or equal to", "at least")
    rule = rule.replace("less than or equal to", "at most").replace("greater than", "more than")
    if rule != message and isinstance(fault["input"], str | int | float):
        message = f"found {fault['input']!r:.80}, expected {rule}"
    return ": ".join(part for part in (".".join(map(str, fault["loc"])), message) if part)


def _plain_os_error(error: OSError) -> str:
    words = {
        errno.EACCES: "permission denied",
        errno.EPERM: "permission denied",
        errno.ENOENT: "no such file or folder",
        errno.EISDIR: "is a folder, expected a file",
        errno.ENOTDIR: "a part of the path is a file, expected a folder",
        errno.EEXIST: "already exists",
        errno.ENOSPC: "no space left on the disk",
        errno.EDQUOT: "no space left in the quota of the disk",
        errno.EROFS: "the file system is read-only",
        errno.ENAMETOOLONG: "the name is too long",
        errno.EMFILE: "too many open files (ulimit -n)",
    }
    what = words.get(error.errno or 0) or error.strerror
    if what is None:
        return str(error)
    name = error.filename2 or error.filename
    return f"{os.fsdecode(name) if isinstance(name, bytes) else name}: {what}" if name else what


ASCII = "placecell_ascii"
"""Alias of ASCII. Typer treats an ASCII stream as misconfigured and writes UTF-8 to it."""


def _find_codec(name: str) -> codecs.CodecInfo | None:
    if name != ASCII:
        return None
    ascii_codec = codecs.lookup("ascii")
    return codecs.CodecInfo(
        ascii_codec.encode,
        ascii_codec.decode,
        incrementalencoder=ascii_codec.incrementalencoder,
        incrementaldecoder=ascii_codec.incrementaldecoder,
        name=ASCII,
    )


codecs.register(_find_codec)


def _prepare_streams() -> None:
    """Escape characters that the terminal cannot show, so that output never fails."""
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if stream is None:  # closed by the shell: `>&-`
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: PTH123, SIM115
        elif hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")
            if codecs.lookup(stream.encoding).name == "ascii":
                stream.reconfigure(encoding=ASCII, errors="backslashreplace")


def _silence(stream: Any) -> None:
    """Discard the rest of a stream's buffer, so that flushing at exit does not fail."""
    try:
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)
    except (OSError, ValueError):
        return  # The stream has no file descriptor.


class Commands(TyperGroup):
    """Root command group: turns exceptions into one line and an exit status."""

    def main(
        self,
        args: Sequence[str] | None = None,
        prog_name: str | None = None,
        complete_var: str | None = None,
        standalone_mode: bool = True,
        windows_expand_args: bool = True,
        **extra: Any,
    ) -> Any:
        words = (args, prog_name, complete_var)
        if not standalone_mode:
            return super().main(*words, False, windows_expand_args, **extra)
        _prepare_streams()
        try:
            status = super().main(*words, False, windows_expand_args, **extra)
        except typer.Abort:
            typer.echo("placecell: The command was aborted. Nothing was changed.", err=True)
            status = FAILED
        except Exception as error:
            # Usage errors, such as an unknown option or a missing argument.
            if not hasattr(error, "format_message"):
                raise
            status = _show_usage(error)
        sys.exit(status if isinstance(status, int) else 0)

    def invoke(self, ctx: Any) -> Any:
        try:
            with clear_errors():
                done = super().invoke(ctx)
            _flush()
            return done
        except BrokenPipeError:
            _silence(sys.stdout)
            raise typer.Exit(PIPE_CLOSED) from None
        except KeyboardInterrupt:
            fail("interrupted", INTERRUPTED)
        except (typer.Exit, typer.Abort):
            _flush()
            raise
        except Exception as error:
            if hasattr(error, "format_message") or os.environ.get(DEBUG_VARIABLE):
                raise
            fail(
                f"Unexpected {type(error).__name__}: {plain(error)}. "
                f"Set {DEBUG_VARIABLE}=1 to see the stack trace."
            )


def _flush() -> None:
    """Flush the output, so that a full disk or a closed pipe is reported now.

    Raises:
        Exit: the output cannot be written.
        BrokenPipeError: the reader has closed the pipe.
    """
    try:
        sys.stdout.flush()
    except BrokenPipeError:
        raise
    except OSError as error:
        _silence(sys.stdout)
        fail(f"standard output: {plain(error)}")


def _show_usage(error: Any) -> int:
    """Print the usage error and the help command on two lines; return the exit status."""
    status = int(error.exit_code)
    context = getattr(error, "ctx", None)
    if type(error).__name__ == "NoArgsIsHelpError":
        error.show()
        return status
    message = " ".join(error.format_message().split())
    typer.secho(f"placecell: {message}", err=True, fg=typer.colors.RED)
    if context is not None:
        typer.echo(f"Try '{context.command_path} --help'.", err=True)
    return status
