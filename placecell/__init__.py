"""What a segment is: drives in, segments out, the model's input. No torch, no web."""

import os

from placecell.core.processors import limit_threads

# ONNX Runtime would report its use to its makers. Read before it is imported.
os.environ.setdefault("ORT_DISABLE_TELEMETRY", "1")

# BLAS and OpenMP start a thread for each core of the host. Read before they are imported.
limit_threads()
