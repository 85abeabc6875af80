"""Checks of outputs: a file or folder that cannot be written is told before the work."""

import os
from pathlib import Path

import typer


def output_file(file: Path | None) -> Path | None:
    """Check that a file can be written; a missing folder will be created.

    Raises:
        BadParameter: It cannot.
    """
    if file is None:
        return None
    if file.is_dir():
        raise typer.BadParameter(f"{file}: is a folder, expected a file.")
    if os.path.lexists(file):
        if not os.access(file, os.W_OK):
            raise typer.BadParameter(f"{file}: cannot be written. Check its permissions.")
    else:
        _check_can_create(file)
    return file


def picture_file(file: Path | None) -> Path | None:
    """Check that a picture can be written, and that its suffix is that of a picture.

    Raises:
        BadParameter: It cannot.
    """
    if file is not None and file.suffix.lower() not in {".png", ".pdf", ".svg"}:
        raise typer.BadParameter(f"{file}: expected a name that ends in .png, .pdf or .svg.")
    return output_file(file)


def output_folder(folder: Path | None) -> Path | None:
    """Check that files can be created in a folder; a missing folder will be created.

    Raises:
        BadParameter: They cannot.
    """
    if folder is None:
        return None
    if os.path.lexists(folder) and not folder.is_dir():
        raise typer.BadParameter(f"{folder}: is a file, expected a folder.")
    _check_can_create(folder / "file")
    return folder


def _check_can_create(file: Path) -> None:
    folder = file.absolute().parent
    while not os.path.lexists(folder):
        folder = folder.parent
    if not folder.is_dir():
        raise typer.BadParameter(f"{file}: {folder} is a file, expected a folder.")
    if not os.access(folder, os.W_OK | os.X_OK):
        raise typer.BadParameter(
            f"{file}: cannot be created. Check the permissions of the folder {folder}."
        )
