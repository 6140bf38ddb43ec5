"""Writes bracket.msh and gears.msh, in mm (pip install gmsh): `python models.py`."""

import math

import gmsh


def groups(dimension, named):
    """Physical groups from lists of tags."""
    for name, tags in named.items():
        gmsh.model.addPhysicalGroup(dimension, tags, name=name)


def write(name, dimension, size):
    """Meshes with quadratic cells."""
    gmsh.option.setNumber("Mesh.MeshSizeMax", size)
    gmsh.model.mesh.generate(dimension)
    gmsh.model.mesh.setOrder(2)
    gmsh.option.setNumber("Mesh.Binary", 1)
    gmsh.option.setNumber("Mesh.MshFileVersion", 2.2)
    gmsh.write(name)
    gmsh.clear()


def bracket():
    """An angle of steel on the ground, held by two bolts whose ends are pulled down."""
    occ = gmsh.model.occ
    foot = occ.addBox(0, 0, 0, 60, 40, 8)
    wall = occ.addBox(0, 32, 8, 60, 8, 32)
    angle, _ = occ.fuse([(3, foot)], [(3, wall)])
    centres = [(15, 15), (45, 15)]
    holes = [(3, occ.addCylinder(x, y, -1, 0, 0, 10, 4.5)) for x, y in centres]
    angle, _ = occ.cut(angle, holes)
    bolts = []
    for x, y in centres:
        shank, head = occ.addCylinder(x, y, 0, 0, 0, 8, 4), occ.addCylinder(x, y, 8, 0, 0, 5, 8)
        bolt, _ = occ.fuse([(3, shank)], [(3, head)])
        bolts += bolt
    occ.synchronize()
    faces = {"foot": [], "seat": [], "load": [], "held ends": [], "heads": []}
    for part, own in [(angle[0], True)] + [(bolt, False) for bolt in bolts]:
        for _, face in gmsh.model.getBoundary([part], oriented=False):
            low, high = gmsh.model.getBoundingBox(2, face)[:3], gmsh.model.getBoundingBox(2, face)[3:]
            flat, height = high[2] - low[2] < 1e-3, 0.5 * (low[2] + high[2])
            if flat and height < 0.1:
                faces["foot" if own else "held ends"].append(face)
            elif flat and abs(height - 8) < 0.1:
                faces["seat" if own else "heads"].append(face)
            elif flat and own and height > 39:
                faces["load"].append(face)
    groups(3, {"angle": [angle[0][1]], "bolts": [tag for _, tag in bolts]})
    groups(2, faces)
    for x, y in centres:
        near = gmsh.model.getEntitiesInBoundingBox(x - 9, y - 9, -1, x + 9, y + 9, 14, 0)
        gmsh.model.mesh.setSize(near, 4)
    write("bracket.msh", 3, 10)


def flank(module, teeth, backlash):
    """Points of one tooth about the x axis, from its lower foot to its upper one: an involute."""
    pitch = 0.5 * module * teeth
    base, tip, root = pitch * math.cos(math.radians(20)), pitch + module, pitch - 1.25 * module
    turned = lambda angle: math.tan(angle) - angle
    half = 0.25 * math.pi * module / pitch - 0.25 * backlash / pitch + turned(math.radians(20))
    points = [(root, half + 0.02)]
    for step in range(9):
        radius = max(base, root + 0.3) + (tip - max(base, root + 0.3)) * step / 8
        points.append((radius, half - turned(math.acos(min(1.0, base / radius)))))
    lower = [(radius, -angle) for radius, angle in points]
    return lower, points[::-1]


def gear(centre, start, module, teeth, shown, backlash):
    """A sector of teeth around a bore; returns the surface, its flanks and its bore."""
    geo = gmsh.model.occ
    place = lambda radius, angle: geo.addPoint(
        centre + radius * math.cos(start + angle), radius * math.sin(start + angle), 0
    )
    lower, upper = flank(module, teeth, backlash)
    tooth, bore = 2 * math.pi / teeth, 0.2 * module * teeth
    curves, flanks, before = [], [], None
    for number in range(shown):
        turn = (number - 0.5 * (shown - 1)) * tooth
        sides = [[place(r, a + turn) for r, a in side] for side in (lower, upper)]
        if before is not None:
            curves.append(geo.addLine(before, sides[0][0]))
        feet = [geo.addLine(sides[0][0], sides[0][1]), geo.addLine(sides[1][-2], sides[1][-1])]
        involutes = [geo.addSpline(sides[0][1:]), geo.addSpline(sides[1][:-1])]
        tip = geo.addLine(sides[0][-1], sides[1][0])
        curves += [feet[0], involutes[0], tip, involutes[1], feet[1]]
        flanks += involutes
        first, before = (sides[0][0] if number == 0 else first), sides[1][-1]
    edge = 0.5 * shown * tooth
    inner = [place(bore, angle) for angle in (edge, 0, -edge)]
    middle = geo.addPoint(centre, 0, 0)
    held = [geo.addCircleArc(inner[0], middle, inner[1]), geo.addCircleArc(inner[1], middle, inner[2])]
    curves += [geo.addLine(before, inner[0]), *held, geo.addLine(inner[2], first)]
    return geo.addPlaneSurface([geo.addCurveLoop(curves)]), flanks, held


def gears():
    """Two sectors of five teeth of module 5, twenty teeth a wheel, on centres 100 mm apart."""
    first = gear(0, 0, 5, 20, 5, 0.05)
    # A space of the second wheel faces the tooth of the first: its sector has four teeth.
    second = gear(100, math.pi, 5, 20, 4, 0.05)
    gmsh.model.occ.synchronize()
    groups(2, {"pinion": [first[0]], "wheel": [second[0]]})
    # The flanks that meet when the wheel turns counter-clockwise: of its teeth above and below the axis.
    mating = {
        "pinion above": [first[1][5]],
        "wheel above": [second[1][3]],
        "pinion below": [first[1][3]],
        "wheel below": [second[1][5]],
    }
    groups(1, mating | {"pinion bore": first[2], "wheel bore": second[2]})
    for curve in first[1] + second[1]:
        ends = gmsh.model.getBoundary([(1, curve)])
        gmsh.model.mesh.setSize(ends, 0.6 if [curve] in mating.values() else 4)
    write("gears.msh", 2, 6)


gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
bracket()
gears()
