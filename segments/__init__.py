"""What a segment is: drives in, segments out, the model's input. No torch, no web."""

import os

# ONNX Runtime would report its use to its makers. Read before it is imported.
os.environ.setdefault("ORT_DISABLE_TELEMETRY", "1")
