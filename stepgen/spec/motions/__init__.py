"""
Motions: when the next step comes. One module per kind.
"""

from typing import TYPE_CHECKING, Annotated, Union

from pydantic import BeforeValidator, Field

from stepgen.spec.base import KindModel, as_kind, kinds_in

KINDS = kinds_in(__name__, __path__)

if TYPE_CHECKING:
    Motion = KindModel
else:
    Motion = Annotated[
        Union[KINDS],  # noqa: UP007 - the members are found at run time
        Field(discriminator="kind"),
        BeforeValidator(as_kind),
    ]
