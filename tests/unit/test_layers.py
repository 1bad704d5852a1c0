"""
The layers: imports go one way only, as the design says.
"""

import ast
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[2] / "stepgen"
FACTS = {"errors", "units"}
BELOW_API = FACTS | {"spec", "devices", "plan", "library", "reference", "verify"}
BELOW_API |= {"datasheet", "draft", "lint", "schema"}
# Layer -> the layers it may import. What is not listed here is no layer, and a test says so.
MAY_IMPORT = {
    "errors": set[str](),
    "units": set[str](),
    "spec": FACTS,
    "devices": FACTS,
    "plan": FACTS | {"spec", "devices"},
    "reference": FACTS | {"spec", "devices"},
    "library": FACTS | {"spec", "devices", "plan"},
    "datasheet": FACTS | {"spec", "devices", "plan", "library"},
    "schema": {"spec", "devices"},
    "draft": FACTS | {"spec", "devices", "plan"},
    "lint": FACTS | {"spec"},
    "verify": FACTS | {"spec", "devices", "plan", "reference", "library"},
    "api": BELOW_API,
    "commands": BELOW_API | {"api"},
    "cli": FACTS | {"commands", "api"},
    "__main__": {"cli"},
}
MODULES = sorted(PACKAGE.rglob("*.py"))


def _layer(module: Path) -> str:
    return module.relative_to(PACKAGE).parts[0].removesuffix(".py")


def _imported_layers(module: Path) -> set[str]:
    """
    Return the layers that *module* imports, wherever in it; the package itself is "".
    """
    names: list[str] = []
    for node in ast.walk(ast.parse(module.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names.extend(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{module} imports relatively"
            names.append(str(node.module))
            if node.module == "stepgen":
                names.extend(f"stepgen.{alias.name}" for alias in node.names)
    inside = [name.split(".") for name in names if name.split(".")[0] == "stepgen"]
    return {parts[1] for parts in inside if len(parts) > 1 and not parts[1].startswith("__")}


@pytest.mark.parametrize("module", MODULES, ids=lambda path: str(path.relative_to(PACKAGE)))
def test_imports_go_one_way(module: Path) -> None:
    """
    A module imports its own layer and those below it, and no other.
    """
    layer = _layer(module)
    if layer == "__init__":
        assert _imported_layers(module) == set()
        return

    assert _imported_layers(module) - {layer} <= MAY_IMPORT[layer]


def test_nobody_but_the_top_imports_verification() -> None:
    """
    Generating needs no simulator: only `api` and the commands know of `verify`.
    """
    users = {_layer(module) for module in MODULES if "verify" in _imported_layers(module)}

    assert users <= {"verify", "api", "commands"}


def test_the_reference_shares_nothing_with_the_plan() -> None:
    """
    The model uses facts only: an oracle that shared the planner's arithmetic would share its bugs.
    """
    used = {
        layer
        for module in MODULES
        if _layer(module) == "reference"
        for layer in _imported_layers(module)
    }

    assert used <= {"reference", "units", "errors", "spec", "devices"}


def test_every_module_belongs_to_a_layer() -> None:
    """
    A new folder or module at the top of the package gets its place in the list above first.
    """
    assert {_layer(module) for module in MODULES} - {"__init__"} == set(MAY_IMPORT)
