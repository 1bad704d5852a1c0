"""
What belongs to the project beside its text: the jobs of CI.
"""

from ruamel.yaml import YAML

from tests.docs.pages import ROOT


def test_ci_verifies_each_spec_once() -> None:
    """
    The board matrix of CI has a job for every spec, by the start of its name.
    """
    text = (ROOT / ".github" / "workflows" / "ci.yml").read_text(encoding="utf-8")
    workflow = YAML(typ="safe", pure=True).load(text)
    boards = workflow["jobs"]["verify"]["strategy"]["matrix"]["board"]

    assert sorted(path.name for path in (ROOT / "specs").glob("*.yaml")) == sorted(
        path.name for board in boards for path in (ROOT / "specs").glob(f"{board}_*.yaml")
    )
