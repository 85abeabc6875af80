"""What storing descriptors costs."""

from pathlib import Path

import numpy as np
import pytest

from bench.ladder import draw, ladder, stored_as
from segments.extractor import load_extractor
from segments.models import MODELS_FOLDER
from segments.parameters import PROTOCOL_V1
from segments.quantiser import Quantiser
from segments.recording import Recording
from segments.types import Float32
from tests.segments.segment_builders import recording_of

