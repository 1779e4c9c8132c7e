"""Plates as a building model: IFC4 through ifcopenshell.

Entities are made one by one and no helper of ifcopenshell is used, since these draw random ids and
take the time of day: the same plates give the same file.
"""

from __future__ import annotations

import uuid
from typing import TYPE_CHECKING, Any, Sequence

import numpy as np

if TYPE_CHECKING:
    from ._panels import Plate

#: Ids are made of names in this space, so that they are the same every time.
_SPACE = uuid.uuid5(uuid.NAMESPACE_URL, "kerfold:ifc")
#: The decimals of coordinates, mm.
_DIGITS = 9


class _Builder:
    def __init__(self, ifcopenshell: Any, name: str) -> None:
        self.file = ifcopenshell.file(schema="IFC4")
        self._compress = ifcopenshell.guid.compress
        self._name = name

    def id(self, *what: str) -> str:
        text = "/".join((self._name, *what))
        return str(self._compress(uuid.uuid5(_SPACE, text).hex))

    def make(self, kind: str, **values: Any) -> Any:
        return self.file.create_entity(kind, **values)

    def value(self, kind: str, value: Any) -> Any:
        return self.file.create_entity(kind, value)

    def point(self, place: Sequence[float]) -> Any:
        numbers = [round(float(x), _DIGITS) + 0.0 for x in place]
        return self.make("IfcCartesianPoint", Coordinates=numbers)

    def direction(self, way: Sequence[float]) -> Any:
        return self.make("IfcDirection", DirectionRatios=[float(x) + 0.0 for x in way])

    def placement(self, below: Any, frame: Any = None) -> Any:
        """A place relative to another one: the origin, or origin, x axis, y axis and normal."""
        if frame is None:
            axes = self.make("IfcAxis2Placement3D", Location=self.point((0, 0, 0)))
        else:
            axes = self.make(
                "IfcAxis2Placement3D",
                Location=self.point(frame[0]),
                Axis=self.direction(frame[3]),
                RefDirection=self.direction(frame[1]),
            )
        return self.make("IfcLocalPlacement", PlacementRelTo=below, RelativePlacement=axes)

    def context(self) -> tuple[Any, Any]:
        """The context of the project and that of bodies."""
        world = self.make("IfcAxis2Placement3D", Location=self.point((0, 0, 0)))
        whole = self.make(
            "IfcGeometricRepresentationContext",
            ContextType="Model",
            CoordinateSpaceDimension=3,
            Precision=1e-5,
            WorldCoordinateSystem=world,
        )
        body = self.make(
            "IfcGeometricRepresentationSubContext",
            ContextIdentifier="Body",
            ContextType="Model",
            ParentContext=whole,
            TargetView="MODEL_VIEW",
        )
        return whole, body

    def units(self) -> Any:
        """Millimetres for lengths, and metres and kilograms for quantities, as IFC files have it."""
        kinds = [
            ("LENGTHUNIT", "MILLI", "METRE"),
            ("AREAUNIT", None, "SQUARE_METRE"),
            ("VOLUMEUNIT", None, "CUBIC_METRE"),
            ("MASSUNIT", "KILO", "GRAM"),
            ("PLANEANGLEUNIT", None, "RADIAN"),
        ]
        units = [
            self.make("IfcSIUnit", UnitType=kind, Prefix=prefix, Name=name)
            for kind, prefix, name in kinds
        ]
        return self.make("IfcUnitAssignment", Units=units)

    def aggregate(self, whole: Any, parts: list[Any]) -> None:
        self.make(
            "IfcRelAggregates",
            GlobalId=self.id("parts of", whole.GlobalId),
            RelatingObject=whole,
            RelatedObjects=parts,
        )

    def define(self, thing: Any, definition: Any) -> None:
        self.make(
            "IfcRelDefinesByProperties",
            GlobalId=self.id("definition", definition.GlobalId),
            RelatedObjects=[thing],
            RelatingPropertyDefinition=definition,
        )


def build(ifcopenshell: Any, plates: Sequence[Plate], name: str) -> Any:
    """The file of plates that make one curtain wall."""
    build = _Builder(ifcopenshell, name)
    whole, body = build.context()
    project = build.make(
        "IfcProject",
        GlobalId=build.id("project"),
        Name=name,
        RepresentationContexts=[whole],
        UnitsInContext=build.units(),
    )
    place, above, thing = None, project, None
    for kind in ["IfcSite", "IfcBuilding", "IfcBuildingStorey"]:
        place = build.placement(place)
        thing = build.make(kind, GlobalId=build.id(kind), Name=name, ObjectPlacement=place)
        build.aggregate(above, [thing])
        above = thing
    wall = build.make(
        "IfcCurtainWall",
        GlobalId=build.id("wall"),
        Name=name,
        ObjectPlacement=build.placement(place),
    )
    build.make(
        "IfcRelContainedInSpatialStructure",
        GlobalId=build.id("contents"),
        RelatedElements=[wall],
        RelatingStructure=thing,
    )
    made = [_plate(build, plate, wall.ObjectPlacement, body) for plate in plates]
    build.aggregate(wall, made)
    header = build.file.header
    header.file_name.name = f"{name}.ifc"
    header.file_name.time_stamp = "1970-01-01T00:00:00"
    header.file_name.originating_system = "kerfold"
    return build.file


def _plate(build: _Builder, plate: Plate, wall: Any, body: Any) -> Any:
    frame = np.asarray(plate.frame, dtype=float)
    # Corners in the plate's own frame: its front lies in the plane z = 0.
    local = (np.asarray(plate.vertices, dtype=float) - frame[0]) @ frame[1:4].T
    points = [[round(x, _DIGITS) + 0.0 for x in row] for row in local.tolist()]
    triangles = [[a + 1, b + 1, c + 1] for a, b, c in np.asarray(plate.triangles).tolist()]
    surface = build.make(
        "IfcTriangulatedFaceSet",
        Coordinates=build.make("IfcCartesianPointList3D", CoordList=points),
        Closed=True,
        CoordIndex=triangles,
    )
    shape = build.make(
        "IfcShapeRepresentation",
        ContextOfItems=body,
        RepresentationIdentifier="Body",
        RepresentationType="Tessellation",
        Items=[surface],
    )
    made = build.make(
        "IfcPlate",
        GlobalId=build.id("plate", plate.id),
        Name=plate.id,
        ObjectType=plate.layer,
        Tag=f"G{plate.group + 1:03}",
        PredefinedType="CURTAIN_PANEL",
        ObjectPlacement=build.placement(wall, frame),
        Representation=build.make("IfcProductDefinitionShape", Representations=[shape]),
    )
    front = np.asarray(plate.front, dtype=float)
    around = float(np.linalg.norm(front - np.roll(front, -1, axis=0), axis=1).sum())
    quantities = [
        build.make("IfcQuantityLength", Name="Width", LengthValue=float(plate.thickness)),
        build.make("IfcQuantityLength", Name="Perimeter", LengthValue=around),
        build.make("IfcQuantityArea", Name="NetArea", AreaValue=float(plate.area) / 1e6),
        build.make("IfcQuantityVolume", Name="NetVolume", VolumeValue=float(plate.volume) / 1e9),
        build.make("IfcQuantityWeight", Name="NetWeight", WeightValue=float(plate.mass)),
    ]
    build.define(
        made,
        build.make(
            "IfcElementQuantity",
            GlobalId=build.id("quantities", plate.id),
            Name="Qto_PlateBaseQuantities",
            Quantities=quantities,
        ),
    )
    mitres = " ".join(f"{mitre:.3f}" for mitre in np.asarray(plate.bevels).tolist())
    values = [
        ("Face", "IfcInteger", int(plate.face)),
        ("Group", "IfcLabel", made.Tag),
        ("Mirrored", "IfcBoolean", bool(plate.is_mirrored)),
        ("MitresDegrees", "IfcText", mitres),
    ]
    properties = [
        build.make("IfcPropertySingleValue", Name=key, NominalValue=build.value(kind, value))
        for key, kind, value in values
    ]
    build.define(
        made,
        build.make(
            "IfcPropertySet",
            GlobalId=build.id("properties", plate.id),
            Name="Kerfold_Plate",
            HasProperties=properties,
        ),
    )
    return made
