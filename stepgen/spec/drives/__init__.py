"""
Drives: how a step reaches the motor. One module per kind.
"""

from typing import TYPE_CHECKING, Annotated, Union

from pydantic import Field

from stepgen.spec.base import KindModel, kind_in_short, kinds_in

KINDS = kinds_in(__name__, __path__)

if TYPE_CHECKING:
    Drive = KindModel
else:
    _ANY = Union[KINDS]  # noqa: UP007 - the members are found at run time
    Drive = Annotated[_ANY, Field(discriminator="kind"), kind_in_short(_ANY, KINDS)]
