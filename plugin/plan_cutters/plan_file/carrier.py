"""The surface that a face is a part of: by it a face is known again in another plan."""

from pydantic import Field

from plan_cutters.plan_file.frozen import Frozen, Vector


class CarrierEntry(Frozen):
    """The whole plane, cylinder, cone, sphere or torus that a face is a part of, as `shape` of the face says."""

    point_mm: Vector = Field(
        description="the point of a plane or of a cylinder's axis that is nearest the origin, the apex of a cone, the centre of "
        "a sphere or torus"
    )
    direction: Vector | None = Field(
        default=None,
        description="unit normal of a plane, unit direction of an axis: the first of its longest components is positive, of a "
        "cone it points from the apex to the face; null of a sphere",
    )
    radius_mm: float | None = Field(
        default=None, description="of a cylinder or sphere, and of the circle about which a torus lies"
    )
    minor_radius_mm: float | None = Field(default=None, description="of the tube of a torus")
    half_angle_deg: float | None = Field(default=None, description="between the axis and the surface of a cone")
    outward: bool | None = Field(
        default=None,
        description="whether the normal out of the material points along a plane's direction, or away from an axis, from a "
        "centre or from the middle of a tube: of a hole it does not; null where that is a guess",
    )
