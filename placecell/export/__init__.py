"""Export: maps and recordings in the files of other programs."""
