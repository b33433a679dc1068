"""STEP files made by hand: boxes, spheres, sheets and assemblies of them, in any unit."""

from __future__ import annotations

from itertools import product

HEAD = (
    "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\n"
    "FILE_NAME('a','2026-01-01T00:00:00',(''),(''),'','','');\n"
    "FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n"
)
TAIL = "ENDSEC;\nEND-ISO-10303-21;\n"
#: Lengths as the standard has them.
UNITS = {
    "m": "(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT($,.METRE.))",
    "cm": "(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.CENTI.,.METRE.))",
    "mm": "(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))",
    "um": "(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MICRO.,.METRE.))",
}
#: Of units that are so many of another, by name.
CONVERTED = {"in": (2.54, "cm"), "ft": (304.8, "mm"), "fathom": (1.8288, "m")}
ORIGIN = ((0, 0, 0), (0, 0, 1), (1, 0, 0))


def number(value):
    """Return a number as STEP spells it: with a point, and the digits that make the same double."""
    text = repr(float(value)).upper()
    return text if "." in text else text.replace("E", ".E")


class StepFile:
    """Collects the entities of a file.

    Args:
        unit: of its lengths; None for none.
    """

    def __init__(self, unit="mm"):
        self.lines = []
        context = self.add("APPLICATION_CONTEXT('mechanical design')")
        self.contexts = (
            self.add(f"PRODUCT_CONTEXT('',{context},'mechanical')"),
            self.add(f"PRODUCT_DEFINITION_CONTEXT('part definition',{context},'design')"),
        )
        self.context = self.lengths(unit)

    def add(self, text):
        self.lines.append(f"#{len(self.lines) + 1}={text};\n")
        return f"#{len(self.lines)}"

    def list(self, names):
        return f"({','.join(names)})"

    def bytes(self):
        return (HEAD + "".join(self.lines) + TAIL).encode()

    def lengths(self, unit):
        """Return a context whose lengths are in a unit."""
        if unit is None:
            return self.add("GEOMETRIC_REPRESENTATION_CONTEXT('','',3)")
        if unit in CONVERTED:
            factor, base = CONVERTED[unit]
            size = self.add("DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.)")
            one = self.add(UNITS[base])
            measure = f"LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE({number(factor)}),{one})"
            length = self.add(
                f"(CONVERSION_BASED_UNIT('{unit}',{self.add(measure)})"
                f"LENGTH_UNIT()NAMED_UNIT({size}))"
            )
        else:
            length = self.add(UNITS[unit])
        angle = self.add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))")
        solid = self.add("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())")
        return self.add(
            "(GEOMETRIC_REPRESENTATION_CONTEXT(3)"
            f"GLOBAL_UNIT_ASSIGNED_CONTEXT(({length},{angle},{solid}))"
            "REPRESENTATION_CONTEXT('',''))"
        )

    def point(self, place):
        return self.add(f"CARTESIAN_POINT('',({','.join(map(number, place))}))")

    def direction(self, way):
        return self.add(f"DIRECTION('',({','.join(map(number, way))}))")

    def axes(self, origin, z, x):
        words = self.point(origin), self.direction(z), self.direction(x)
        return self.add(f"AXIS2_PLACEMENT_3D('',{','.join(words)})")

    def faces_of_box(self, low, high):
        """Return the six faces of a box, outside out."""
        ends = low, high
        place = {key: tuple(ends[key[k]][k] for k in range(3)) for key in product((0, 1), repeat=3)}
        vertex = {k: self.add(f"VERTEX_POINT('',{self.point(p)})") for k, p in place.items()}
        edges = {}

        def edge(a, b):
            first, last = min(a, b), max(a, b)
            if (first, last) not in edges:
                way = [q - p for p, q in zip(place[first], place[last], strict=True)]
                vector = self.add(f"VECTOR('',{self.direction(way)},1.)")
                line = self.add(f"LINE('',{self.point(place[first])},{vector})")
                ends = f"{vertex[first]},{vertex[last]}"
                edges[first, last] = self.add(f"EDGE_CURVE('',{ends},{line},.T.)")
            sense = ".T." if (a, b) == (first, last) else ".F."
            return self.add(f"ORIENTED_EDGE('',*,*,{edges[first, last]},{sense})")

        faces = []
        for axis, end in product(range(3), (0, 1)):
            u, v = ((1, 2), (2, 0), (0, 1))[axis]
            corners = []
            for at in ((0, 0), (1, 0), (1, 1), (0, 1)):
                key = [0, 0, 0]
                key[axis], key[u], key[v] = end, *at
                corners.append(tuple(key))
            corners = corners if end else corners[::-1]
            around = [edge(a, b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)]
            loop = self.add(f"EDGE_LOOP('',{self.list(around)})")
            z, x = [0, 0, 0], [0, 0, 0]
            z[axis], x[u] = (1 if end else -1), 1
            plane = self.add(f"PLANE('',{self.axes(place[corners[0]], z, x)})")
            bound = self.add(f"FACE_OUTER_BOUND('',{loop},.T.)")
            faces.append(self.add(f"ADVANCED_FACE('',({bound}),{plane},.T.)"))
        return faces

    def face_of_sphere(self, radius, center=(0, 0, 0)):
        """Return the one face of a sphere, bounded by its south pole."""
        x, y, z = center
        pole = self.add(f"VERTEX_POINT('',{self.point((x, y, z - radius))})")
        loop = self.add(f"VERTEX_LOOP('',{pole})")
        bound = self.add(f"FACE_BOUND('',{loop},.T.)")
        axes = self.axes(center, (0, 0, 1), (1, 0, 0))
        ball = self.add(f"SPHERICAL_SURFACE('',{axes},{number(radius)})")
        return self.add(f"ADVANCED_FACE('',({bound}),{ball},.T.)")

    def solid(self, faces):
        shell = self.add(f"CLOSED_SHELL('',{self.list(faces)})")
        return self.add(f"MANIFOLD_SOLID_BREP('',{shell})")

    def sheet(self, faces):
        shell = self.add(f"OPEN_SHELL('',{self.list(faces)})")
        return self.add(f"SHELL_BASED_SURFACE_MODEL('',({shell}))")

    def definition(self, name):
        """Return the definition of a product, and of its shape."""
        made = self.add(f"PRODUCT('{name}','{name}','',({self.contexts[0]}))")
        version = self.add(f"PRODUCT_DEFINITION_FORMATION('','',{made})")
        defined = self.add(f"PRODUCT_DEFINITION('design','',{version},{self.contexts[1]})")
        return defined, self.add(f"PRODUCT_DEFINITION_SHAPE('','',{defined})")

    def product(self, name, items, kind="ADVANCED_BREP_SHAPE_REPRESENTATION", context=None):
        """Return a product of items, as its definition and its representation."""
        defined, shape = self.definition(name)
        listed = self.list([*items, self.axes(*ORIGIN)])
        drawn = self.add(f"{kind}('{name}',{listed},{context or self.context})")
        self.add(f"SHAPE_DEFINITION_REPRESENTATION({shape},{drawn})")
        return defined, drawn

    def assembly(self, name, *parts):
        """Return a product that is assembled of `(instance name, product, (origin, z, x))`."""
        places = [self.axes(*place) for _, _, place in parts]
        whole = self.product(name, places, "SHAPE_REPRESENTATION")
        start = self.axes(*ORIGIN)
        for number_, ((instance, part, _), place) in enumerate(zip(parts, places, strict=True)):
            use = self.add(
                f"NEXT_ASSEMBLY_USAGE_OCCURRENCE('{number_}','{instance}','',{whole[0]},{part[0]},$)"
            )
            used = self.add(f"PRODUCT_DEFINITION_SHAPE('','',{use})")
            turned = self.add(f"ITEM_DEFINED_TRANSFORMATION('','',{start},{place})")
            related = self.add(
                f"(REPRESENTATION_RELATIONSHIP('','',{part[1]},{whole[1]})"
                f"REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION({turned})"
                "SHAPE_REPRESENTATION_RELATIONSHIP())"
            )
            self.add(f"CONTEXT_DEPENDENT_SHAPE_REPRESENTATION({related},{used})")
        return whole


def box(low=(0, 0, 0), high=(1, 2, 3), unit="mm", name="box"):
    file = StepFile(unit)
    file.product(name, [file.solid(file.faces_of_box(low, high))])
    return file.bytes()


def sphere(radius=10.0, center=(0, 0, 0), unit="mm"):
    file = StepFile(unit)
    file.product("ball", [file.solid([file.face_of_sphere(radius, center)])])
    return file.bytes()


STEP_SEEDS = (box(), sphere())
