"""
What users install: the wheel and the source archive, away from this checkout.
"""

import subprocess
import sys
import tarfile
import venv
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SPEC = ROOT / "specs" / "uno_motor_shield.yaml"
TEXTS = ("README.md", "CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md")


def run(*command: str | Path, cwd: Path) -> str:
    """
    Run *command* in *cwd* and return what it printed; it must end with 0.
    """
    done = subprocess.run(
        [str(part) for part in command], cwd=cwd, capture_output=True, check=False, encoding="utf-8"
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def sources(folder: str, *patterns: str) -> set[str]:
    """
    Return the files of this checkout's *folder* that match one of *patterns*, relative to it.
    """
    base = ROOT / folder
    return {
        path.relative_to(base).as_posix()
        for pattern in patterns
        for path in base.rglob(pattern)
        if path.is_file() and "__pycache__" not in path.parts
    }


def build_wheel(source: Path, folder: Path) -> None:
    """
    Build the wheel of *source*, a folder or an archive, into *folder*.
    """
    pip_wheel = (sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps")
    run(*pip_wheel, "--wheel-dir", folder, source, cwd=folder)


@pytest.fixture(scope="module")
def checkout(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """
    Return a copy of what packaging reads, so that nothing of it is built in the checkout.
    """
    folder = tmp_path_factory.mktemp("checkout")
    wanted = ["pyproject.toml", "LICENSE", ".gitignore", "Makefile", *TEXTS]
    parts = ("stepgen", "templates", "docs")
    wanted += [f"{part}/{path}" for part in parts for path in sources(part, "*")]
    for path in wanted:
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_bytes((ROOT / path).read_bytes())
    return folder


@pytest.fixture(scope="module")
def wheel(checkout: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """
    Return the wheel, built the way `pip install` builds it.
    """
    folder = tmp_path_factory.mktemp("wheel")
    build_wheel(checkout, folder)
    (built,) = folder.glob("stepgen-*.whl")
    return built


def test_the_wheel_holds_all_that_stepgen_reads(wheel: Path) -> None:
    """
    Modules, type marker, the harness's C files and the templates; nothing of tests or specs.
    """
    with zipfile.ZipFile(wheel) as archive:
        names = set(archive.namelist())

    package = {name.removeprefix("stepgen/") for name in names if name.startswith("stepgen/")}
    templates = {
        name.removeprefix("_templates/") for name in package if name.startswith("_templates/")
    }
    assert sources("stepgen", "*.py", "*.c", "*.h", "*.js", "py.typed") <= package
    assert {"py.typed", "verify/simavr/harness.c", "verify/simavr/api.h"} <= package
    assert templates == sources("templates", "*")
    assert {name.split("/")[0] for name in names} == {
        "stepgen",
        wheel.name.removesuffix("-py3-none-any.whl") + ".dist-info",
    }


@pytest.fixture(scope="module")
def archive(checkout: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """
    Return the source archive, made by the project's build backend.
    """
    folder = tmp_path_factory.mktemp("archive")
    builder = folder / "builder" / "bin" / "python"
    venv.create(folder / "builder", with_pip=True)
    run(builder, "-m", "pip", "install", "--quiet", "hatchling", cwd=folder)
    run(builder, "-m", "hatchling", "build", "-t", "sdist", "-d", folder, cwd=checkout)
    (built,) = folder.glob("stepgen-*.tar.gz")
    return built


@pytest.mark.parametrize("kind", ["wheel", "archive"])
def test_what_is_installed_generates_in_an_empty_environment(
    kind: str, tmp_path: Path, request: pytest.FixtureRequest
) -> None:
    """
    Installed with its runtime dependencies only, it writes the library that the checkout writes.
    """
    venv.create(tmp_path / "venv", with_pip=True)
    bin_dir = tmp_path / "venv" / "bin"
    package = request.getfixturevalue(kind)
    run(bin_dir / "python", "-m", "pip", "install", "--quiet", package, cwd=tmp_path)
    (tmp_path / "shield.yaml").write_bytes(SPEC.read_bytes())

    run(bin_dir / "stepgen", "generate", "shield.yaml", "--output", "installed", cwd=tmp_path)
    run(
        *(sys.executable, "-m", "stepgen", "generate", "shield.yaml", "--output", "checkout"),
        cwd=tmp_path,
    )

    def tree(folder: Path) -> dict[str, bytes]:
        return {
            path.relative_to(folder).as_posix(): path.read_bytes()
            for path in folder.rglob("*")
            if path.is_file()
        }

    assert tree(tmp_path / "installed") == tree(tmp_path / "checkout")
    where = run(bin_dir / "python", "-c", "import stepgen; print(stepgen.__file__)", cwd=tmp_path)
    assert Path(where.strip()).is_relative_to(tmp_path / "venv")
    assert (Path(where.strip()).parent / "py.typed").is_file()


def test_the_source_archive_builds_the_same_package(
    archive: Path, wheel: Path, tmp_path: Path
) -> None:
    """
    A wheel made from the source archive holds the same files as one made from the checkout.
    """
    build_wheel(archive, tmp_path)

    with (
        zipfile.ZipFile(tmp_path / wheel.name) as from_archive,
        zipfile.ZipFile(wheel) as from_checkout,
    ):
        assert sorted(from_archive.namelist()) == sorted(from_checkout.namelist())


def test_the_source_archive_has_the_documents(archive: Path) -> None:
    """
    What people read comes with it: README and the like, and every page of docs/.
    """
    with tarfile.open(archive) as opened:
        names = {name.partition("/")[2] for name in opened.getnames()}

    assert {*TEXTS, "LICENSE", "Makefile"} <= names
    assert {f"docs/{path}" for path in sources("docs", "*")} <= names
