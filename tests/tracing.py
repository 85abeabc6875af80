"""Trace functions of many threads: what coverage needs before Python 3.12."""

import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from _typeshed import TraceFunction

settrace_of_python = sys.settrace


def settrace(function: "TraceFunction | None", /) -> None:
    """Install a trace function, also while another thread installs one.

    Python before 3.12 refuses the second one if an audit hook lets another thread run meanwhile
    (python/cpython#98257). Coverage traces each new thread, so a refused thread would never begin.
    """
    while True:
        try:
            return settrace_of_python(function)
        except RuntimeError as error:
            if "another trace function" not in str(error):
                raise
