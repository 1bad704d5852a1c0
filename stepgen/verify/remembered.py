"""
Reports of verification that are kept, as long as nothing changes of what they depend on.
"""

import functools
from pathlib import Path

from pydantic import TypeAdapter

from stepgen.library.render import template_dir
from stepgen.plan.planner import make_plan
from stepgen.spec import LoadedSpec
from stepgen.verify.arduino_core import Toolchain, core_key
from stepgen.verify.cache import build_once, cache_dir, content_key
from stepgen.verify.compilers import Compiler
from stepgen.verify.conformance.needs import refusal
from stepgen.verify.recipes import Target
from stepgen.verify.report import SpecReport
from stepgen.verify.simulators import Simulator
from stepgen.verify.verification import verify_spec

_KIND = "report"
_FILE = "report.json"
_JSON: TypeAdapter[SpecReport | str] = TypeAdapter(SpecReport | str)


def remembered_report(
    loaded: LoadedSpec, compiler: Compiler, simulator: Simulator, *, may_refuse: bool
) -> SpecReport | str:
    """
    Return the report of `verify_spec`, verified now or found in the cache if it passed then.

    It is found by the spec, all of stepgen, the Arduino core, the compiler and the simulator. With
    *may_refuse*, why the simulator cannot be used for the spec, if that is so.

    Raises:
        StepgenError: As of `verify_spec`.
    """
    plan = make_plan(loaded)
    target = Target.from_fqbn(plan.board.fqbn)
    core = core_key(Toolchain(target, compiler))
    spec = (str(loaded.document.path), loaded.document.text)
    key = content_key([stepgen_key(), *spec, core, compiler.name, simulator.title, str(may_refuse)])
    entry = cache_dir() / _KIND / key
    if entry.is_dir():
        return _JSON.validate_json((entry / _FILE).read_bytes())
    reason = refusal(plan, simulator, compiler) if may_refuse else ""
    found = reason or verify_spec(loaded, compiler, simulator=simulator)
    if isinstance(found, str) or found.passed:
        build_once(_KIND, key, lambda out: _write(out / _FILE, found))
    return found


def _write(path: Path, found: SpecReport | str) -> None:
    path.write_bytes(_JSON.dump_json(found))


@functools.cache
def stepgen_key() -> str:
    """
    Return a name for the contents of stepgen itself: its code and its templates.
    """
    roots = (Path(__file__).parents[1], template_dir())
    paths = [
        path
        for root in roots
        for path in sorted(root.rglob("*"))
        if path.is_file() and path.suffix != ".pyc"
    ]
    return content_key([part for path in paths for part in (path.name, path.read_bytes())])
