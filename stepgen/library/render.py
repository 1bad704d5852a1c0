"""
From a view to the files of the library, as text.
"""

import functools
import re
from hashlib import sha256
from importlib.resources import files
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from jinja2.ext import Extension

from stepgen.library.text import block, c_comment, c_string, markdown, more, properties_value, tidy
from stepgen.library.view import LibraryView, make_view
from stepgen.plan.model import Plan

HASH_DIGITS = 12

# Output path -> template; {name} is the library's name.
_FILES = {
    "src/{name}.h": "src/library.h.j2",
    "src/{name}.cpp": "src/library.cpp.j2",
    "library.properties": "library.properties.j2",
    "library.json": "library.json.j2",
    "keywords.txt": "keywords.txt.j2",
    "README.md": "README.md.j2",
    "LICENSE": "LICENSE.j2",
}


class KeepEmptyLines(Extension):
    """
    Keeps the empty lines that follow a control line, which Jinja would swallow with it.

    So a template shows what it prints.
    """

    _AFTER_CONTROL = re.compile(r"^([ \t]*%%[^\n]*\n)(?=[ \t]*\n)", re.MULTILINE)

    def preprocess(self, source: str, name: str | None, filename: str | None = None) -> str:  # noqa: ARG002 - Jinja's signature
        """
        Return *source* with an empty expression in each of those lines.
        """
        return self._AFTER_CONTROL.sub(r"\1{{ '' }}", source)


def template_dir() -> Path:
    """
    Return the folder of the templates: beside the package in a checkout, inside it in a wheel.
    """
    package = Path(str(files("stepgen")))
    bundled = package / "_templates"
    return bundled if bundled.is_dir() else package.parent / "templates"


def environment(templates: Path | None = None) -> Environment:
    """
    Return the one Jinja environment; *templates* replaces the folder that comes with stepgen.

    It is kept, and with it the templates that it has compiled: they take most of the time of
    a library. A template whose file changes is compiled again.
    """
    return _environment(templates or template_dir())


@functools.lru_cache(maxsize=2)
def _environment(templates: Path) -> Environment:
    made = Environment(
        loader=FileSystemLoader(templates),
        undefined=StrictUndefined,
        extensions=[KeepEmptyLines],
        keep_trailing_newline=True,
        trim_blocks=True,
        lstrip_blocks=True,
        line_statement_prefix="%%",
        line_comment_prefix="%#",
        autoescape=False,  # noqa: S701 - C++ is no HTML; text of a spec goes through filters
    )
    made.filters.update(
        block=block,
        more=more,
        c_comment=c_comment,
        c_string=c_string,
        markdown=markdown,
        properties_value=properties_value,
    )
    return made


def spec_hash(text: str) -> str:
    """
    Return the digits that tell one spec from another in the banner of each file.
    """
    return sha256(text.encode()).hexdigest()[:HASH_DIGITS]


def render_library(plan: Plan, spec_text: str, templates: Path | None = None) -> dict[str, str]:
    """
    Return the files of the library of *plan*, path -> text, in a fixed order.

    The same plan and spec give the same bytes: no date, no path of this machine.
    """
    made = environment(templates)
    view = make_view(plan, spec_hash(spec_text))
    context = {"library": view, **_partials(made, view)}
    templates_by_path = {path.format(name=view.name): file for path, file in _FILES.items()}
    for example in view.examples.sketches:
        templates_by_path[example.path] = f"examples/{example.name}.ino.j2"
    rendered = {
        path: tidy(made.get_template(file).render(context))
        for path, file in templates_by_path.items()
    }
    rendered["extras/spec.yaml"] = spec_text
    return dict(sorted(rendered.items()))


def _partials(made: Environment, view: LibraryView) -> dict[str, object]:
    """
    Return the macros of each kind that *view* uses, by their kind.
    """

    def modules(folder: str, names: set[str]) -> dict[str, object]:
        return {name: made.get_template(f"{folder}/{name}.j2").module for name in sorted(names)}

    timings = {name for m in view.motors for name in (m.timing_name, m.timer.shared_by)}
    return {
        "apis": modules("apis", set(view.api_names)),
        "kernels": modules("kernels", {motor.kernel_name for motor in view.motors}),
        "timings": modules("timings", timings),
        "motions": modules("motions", {motor.motion_name for motor in view.motors}),
        "limits_of": modules("limits", {motor.limits_name for motor in view.motors}),
        "timeouts": modules("timeouts", {motor.timeout_name for motor in view.motors}),
        "watchdogs": modules("watchdogs", {view.watchdog_name}),
        "consoles": modules("consoles", set(view.api_names)),
        "addressees": modules("addressees", {view.examples.console.addressee}),
        "others": modules("others", {other.partial for other in view.examples.neighbours}),
    }
