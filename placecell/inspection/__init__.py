"""Inspection: tells what a source holds, what Placecell will use, and how to cure its problems."""
