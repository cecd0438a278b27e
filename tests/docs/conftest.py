"""The tests of the documents share the reader of their code blocks, which is imported by name."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
