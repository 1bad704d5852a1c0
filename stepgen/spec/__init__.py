"""
What the user writes: pydantic models of a spec, loaded with line numbers.
"""

from stepgen.spec.load import LoadedSpec, load_spec
from stepgen.spec.model import Library, Motor, Spec

__all__ = ["Library", "LoadedSpec", "Motor", "Spec", "load_spec"]
