"""
Whatever bytes a file holds, it is a spec or has faults with a place and a way out.
"""

import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from stepgen import api
from stepgen.errors import StepgenError
from tests.fuzz.specs import mutated_bytes, nearly_valid_specs, to_yaml

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
CORPUS = sorted((HERE / "corpus").iterdir())
EXAMPLES, CAMPAIGN_EXAMPLES = 100, 5000
FUZZING_S = 600

repeatable = settings(
    derandomize=True, deadline=None, suppress_health_check=list(HealthCheck), database=None
)


def is_spec(path: Path, content: bytes) -> bool:
    """
    Tell whether *content* is a spec, of which a library can be made; else check its faults.
    """
    path.write_bytes(content)
    try:
        files = api.render(path)
    except StepgenError as error:
        for fault in error.faults:
            assert fault.place.startswith(f"{path}:"), fault
            assert fault.reason == " ".join(fault.reason.split()), fault
            assert fault.reason, fault
        return False
    assert all(text.encode() for text in files.values())
    return True


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """
    Return where the spec of a test is written.
    """
    return tmp_path_factory.mktemp("fuzz") / "spec.yaml"


@pytest.mark.parametrize("found", CORPUS, ids=lambda found: found.name)
def test_what_the_fuzzer_found(path: Path, found: Path) -> None:
    """
    Each file by which the fuzzer came into other code is refused cleanly, or is a spec.
    """
    is_spec(path, found.read_bytes())


@given(data=nearly_valid_specs())
@settings(repeatable, max_examples=EXAMPLES)
def test_a_spec_that_is_nearly_valid(path: Path, data: dict[str, Any]) -> None:
    """
    A spec with something missing, odd, doubled or misplaced is refused cleanly, or is one.
    """
    is_spec(path, to_yaml(data))


@given(content=mutated_bytes())
@settings(repeatable, max_examples=EXAMPLES)
def test_a_file_with_other_bytes(path: Path, content: bytes) -> None:
    """
    A spec's file with stretches cut out, doubled or written over is refused cleanly, or is one.
    """
    is_spec(path, content)


@pytest.mark.campaign
@given(content=st.one_of(nearly_valid_specs().map(to_yaml), mutated_bytes(), st.binary()))
@settings(repeatable, max_examples=CAMPAIGN_EXAMPLES)
def test_a_campaign_of_bad_files(path: Path, content: bytes) -> None:
    """
    Many more of both kinds, and any bytes.
    """
    is_spec(path, content)


@pytest.mark.campaign
def test_ten_minutes_of_fuzzing() -> None:
    """
    The fuzzer finds no crash, nothing slow and nothing large; new finds go to build/fuzz.
    """
    kept = ROOT / "build" / "fuzz"
    kept.mkdir(parents=True, exist_ok=True)
    folders = [kept, HERE / "corpus", ROOT / "specs", ROOT / "specs" / "refused"]
    options = [f"-max_total_time={FUZZING_S}", f"-dict={HERE / 'spec.dict'}"]
    done = subprocess.run(
        [sys.executable, str(HERE / "fuzz_loader.py"), *map(str, folders), *options],
        cwd=kept.parent,
        capture_output=True,
        text=True,
        check=False,
        timeout=FUZZING_S + 120,
    )

    assert done.returncode == 0, done.stderr[-3000:]
