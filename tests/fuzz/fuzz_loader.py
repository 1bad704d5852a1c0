"""
The fuzzer of the loader: ``fuzz_loader.py CORPUS_FOLDER... [-max_total_time=600 ...]``.

Any bytes are a valid spec or faults with a place and a way out; anything else is a crash, and
so is more than 2 s of CPU time or 300 MB for one of them. The options are libFuzzer's; its own
time-out, of the clock on the wall, is for what hangs: how busy the machine is decides nothing.
"""

import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

import atheris

with atheris.instrument_imports(include=["ruamel.yaml", "stepgen"]):
    from stepgen.errors import StepgenError
    from stepgen.plan.planner import make_plan
    from stepgen.spec import load_spec

LIMITS = ("-timeout=60", "-rss_limit_mb=300", "-max_len=4096")
CPU_S = 2


def try_bytes(path: Path, content: bytes) -> None:
    """
    Load *content* as a spec, and plan it; faults must say where they are.
    """
    path.write_bytes(content)
    began = time.process_time()
    try:
        make_plan(load_spec(path))
    except StepgenError as error:
        for fault in error.faults:
            line = " ".join(fault.reason.split())
            if fault.reason != line or not fault.place.startswith(f"{path}:"):
                raise AssertionError(fault) from error
    took = time.process_time() - began
    if took > CPU_S:
        raise AssertionError(f"{took:.1f} s of CPU time")


def main() -> None:
    """
    Fuzz until libFuzzer's options say stop.
    """
    with TemporaryDirectory() as folder:
        path = Path(folder) / "spec.yaml"
        atheris.Setup([*sys.argv, *LIMITS], lambda content: try_bytes(path, content))
        atheris.Fuzz()


if __name__ == "__main__":
    main()
