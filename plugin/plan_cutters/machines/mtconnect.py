"""MTConnect devices, the answer to a `probe`: axes with their specifications.

A device says which axes it has, not which stands on which, nor whether one carries the part or the tool. Names are those of
ISO 841, and so are directions and signs.
"""

import re
from collections.abc import Iterator

from plan_cutters.domain.axis import Axis
from plan_cutters.domain.checks import shown
from plan_cutters.domain.machine import Machine
from plan_cutters.errors import MachineError
from plan_cutters.files.xml_tree import Element
from plan_cutters.machines import chain
from plan_cutters.machines.arrangement import arranged
from plan_cutters.machines.files import Added, Content

_ROOT = re.compile(r"<\s*(?:\w+:)?MTConnectDevices\b")
_NAME = re.compile(r"([A-Z])(\d*)")
_TURNS = ("ROTARY_VELOCITY", "SPINDLE_SPEED")
#: What limits a position, by the kind of axis: types of specifications and of data items.
_WHERE = {"linear": ("POSITION", "LENGTH"), "rotary": ("ANGLE", "POSITION")}
_SPEED = {"linear": ("VELOCITY", "AXIS_FEEDRATE"), "rotary": ("ANGULAR_VELOCITY", "VELOCITY")}
_PARALLEL = 1e-9


def is_probe(content: Content) -> bool:
    """XML with the root `MTConnectDevices`."""
    return content.head.startswith("<") and _ROOT.search(content.text, 0, 1 << 16) is not None


def read_probe(content: Content, added: Added) -> Machine:
    """Read it."""
    root = content.xml()
    if root.tag != "MTConnectDevices":
        raise MachineError(f"is XML with the root {root.tag[:40]}, not MTConnectDevices")
    device, components = _device(root)
    notes: list[str] = []
    own_axes = [axis for each in components if (axis := _axis(each, added, notes)) is not None]
    rotary = arranged([each for each in own_axes if each.kind == "rotary"], added, notes, "MTConnect")
    between = [each for each in own_axes if each.kind == "linear"]
    if not between and not rotary:
        raise MachineError("it has no axis X, Y, Z, A, B or C")
    axes = [*(a for a in rotary if a.carries == "part"), *between, *(a for a in rotary if a.carries == "tool")]
    return chain.machine(device.given.get("name") or content.path.stem, axes, notes)


def _device(root: Element) -> tuple[Element, list[Element]]:
    """The only device that has axes, and these."""
    devices = [each for top in root.children if top.tag == "Devices" for each in top.children if each.tag == "Device"]
    with_axes = [(device, axes) for device in devices if (axes := list(_components(device)))]
    if len(with_axes) != 1:
        names = ", ".join(shown(device.given.get("name", "")) for device, _ in with_axes)
        what = f"{len(with_axes)} devices have axes ({names})" if with_axes else "no device of it has axes"
        raise MachineError(f"{what}: give a file with one machine")
    return with_axes[0]


def _components(element: Element) -> Iterator[Element]:
    """Linear and rotary axes anywhere below a device."""
    waiting = [element]
    while waiting:
        each = waiting.pop()
        if each.tag in ("Linear", "Rotary"):
            yield each
        waiting += [child for child in each.children[::-1] if child.tag not in ("DataItems", "Description")]


def _own(element: Element, tag: str) -> Iterator[Element]:
    """Elements of a component itself, not of those below it."""
    for child in element.children:
        if child.tag == tag:
            yield child
        elif child.tag != "Components":
            yield from _own(child, tag)


def _axis(component: Element, added: Added, notes: list[str]) -> Axis | None:
    """An axis; None, and a note, where it is none that positions."""
    name = (component.given.get("name") or component.given.get("nativeName") or component.given.get("id", "")).strip()
    rotary = component.tag == "Rotary"
    items = [
        each.given.get("type", "").rpartition(":")[2].upper()
        for tag in ("DataItem", "Specification")
        for each in _own(component, tag)
    ]
    match = _NAME.fullmatch(name.upper())
    letters = "ABC" if rotary else "XYZ"
    if rotary and (name.upper().startswith("S") or any(each in _TURNS for each in items)):
        notes.append(f"{name} is a spindle, which turns the tool about itself: it is ignored")
        return None
    if match is None or match[1] not in letters or match[2] not in ("", "1"):
        if rotary:
            raise MachineError(
                f"line {component.line}: its rotary axis {shown(name)} is none of A, B, C: what it turns about is not known"
            )
        notes.append(f"{name} is none of X, Y, Z: it is ignored")
        return None
    motion = next(_own(component, "Motion"), None)
    direction, point, moves = chain.ISO[match[1]], (0.0, 0.0, 0.0), None
    if motion is not None:
        moves = motion.given.get("type", "").upper()
        direction = _along(motion, direction, f"line {motion.line}: axis {name}", added)
        origin = motion.first("Origin")
        if origin is not None:
            point = _three(origin, f"line {origin.line}: the origin of {name}")
    if moves == "FIXED":
        notes.append(f"{name} does not move (FIXED): it is ignored")
        return None
    kind = "rotary" if rotary else "linear"
    limits = _limits(component, kind, name)
    rate = _rate(component, kind)
    # Until it is said what carries what: see `arranged`.
    if rotary:
        return chain.axis(name.upper(), "rotary", "part", direction, limits=limits, point=point, rate=rate)
    return chain.axis(name.upper(), "linear", "tool", direction, limits=limits, rate=rate)


def _along(motion: Element, iso: chain.Vector, what: str, added: Added) -> chain.Vector:
    """The direction of an axis: that of its name, unless its motion runs along another line."""
    element = motion.first("Axis")
    if element is None:
        return iso
    vector = _three(element, f"{what}: its direction")
    size = sum(v * v for v in vector) ** 0.5
    along = sum(p * q for p, q in zip(vector, iso, strict=True))
    if size and abs(abs(along) / size - 1.0) <= _PARALLEL:
        return iso
    if added.sign:
        return vector
    raise MachineError(
        f"{what} runs along ({', '.join(f'{v:g}' for v in vector)}), not as its name has it in ISO 841, and whether that is the "
        "motion of the part or of the tool is not stated: say it as FILE#table or FILE#tool-relative"
    )


def _three(element: Element, what: str) -> chain.Vector:
    words = element.text.split()
    try:
        numbers = [float(word) for word in words]
    except ValueError:
        numbers = []
    return chain.vector(numbers, what) if len(numbers) == 3 else chain.vector(None, what)


def _ends(element: Element, units: str, kind: str, what: str) -> tuple[float, float] | None:
    """The least and largest value below an element."""
    values: dict[str, float | None] = {}
    for tag in ("Minimum", "Maximum"):
        ends = list(_own(element, tag))
        try:
            values[tag] = chain.real(float(ends[0].text), f"{what}: its {tag}") if ends else None
        except ValueError:
            raise MachineError(f"{what}: its {tag} {shown(ends[0].text.strip())} is no number") from None
    if values["Minimum"] is None and values["Maximum"] is None:
        return None
    known = chain.ANGLES if kind == "rotary" else chain.LENGTHS
    return chain.ranged(values["Minimum"], values["Maximum"], chain.unit(units, known, f"{what}: the unit of its limits"))


def _limits(component: Element, kind: str, name: str) -> tuple[float, float] | None:
    limits = []
    for tag in ("Specification", "ProcessSpecification", "DataItem"):
        for each in _own(component, tag):
            if each.given.get("type", "").upper() in _WHERE[kind]:
                limits.append(_ends(each, each.given.get("units", ""), kind, f"line {each.line}: axis {name}"))
    return chain.narrowed(limits, f"axis {name}")


def _rate(component: Element, kind: str) -> float | None:
    """Its largest speed, where a unit a second is said."""
    for each in _own(component, "Specification"):
        units, _, time = each.given.get("units", "").partition("/")
        size = (chain.ANGLES if kind == "rotary" else chain.LENGTHS).get(units.lower())
        largest = next(_own(each, "Maximum"), None)
        if each.given.get("type", "").upper() in _SPEED[kind] and size and time == "SECOND" and largest is not None:
            try:
                value = float(largest.text)
            except ValueError:
                return None
            return chain.scaled(value, size) if 0.0 < value < 1e12 else None
    return None
