"""A problem of a source, with its cure."""

import re
from dataclasses import dataclass
from typing import Literal

Severity = Literal["error", "warning", "info"]

CURE = re.compile(
    r"(?<=[.;:)])\s+(?=(?:Expected|Play|State|Check|Record|Copy|Write|Rename|Convert|Give|Choose|"
    r"Open|Add|Remove|Move|Use|Invert|Run|Install|Prepare|If|expected|state|add|convert)\b)"
)
DEFAULT_CURE = "Correct the file, and inspect it again."


@dataclass(frozen=True, slots=True)
class SourceProblem:
    """SourceProblem of a source.

    Attributes:
        severity: `error`: the source cannot be used; `warning`: results suffer; `info`: the user
            should know how it was handled.
        what: what was found.
        cure: what the user can do.
    """

    severity: Severity
    what: str
    cure: str

    @classmethod
    def of(cls, severity: Severity, message: object, cure: str = DEFAULT_CURE) -> "SourceProblem":
        """Split the message of a reader into what was found and what to do."""
        what, *rest = CURE.split(str(message).strip(), maxsplit=1)
        return cls(severity, what.rstrip(";:"), rest[0] if rest else cure)
