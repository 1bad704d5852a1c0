"""
The picture of the wiring: with every wire drawn if that fits on paper, else with tags on the pins.
"""

from stepgen.datasheet.routed import routed_scene
from stepgen.datasheet.scene import Scene
from stepgen.datasheet.tagged import WIDEST, tagged_scene
from stepgen.plan.model import Plan

_HIGHEST = 560


def wiring_scene(plan: Plan) -> Scene:
    """
    Return the picture of the wiring of *plan*, at most as wide as paper.

    Raises:
        KeyError: The board, or one of the pins, is on no outline.
    """
    scene = routed_scene(plan)
    fits = float(scene.width) <= WIDEST and float(scene.height) <= _HIGHEST
    return scene if fits else tagged_scene(plan)
