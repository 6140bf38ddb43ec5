"""Writes F_*: two blocks with a common face, by Gmsh, meshio and VTK (pip install gmsh meshio vtk)."""

import gmsh
import meshio
import vtk

GROUPS = {"left block": 0, "right block": 1}


def mesh(name, hexahedra, dimension):
    """A block [0, 2] and one [2, 3] along x, 1 wide and high, quadratic; groups of both and of x = 0."""
    gmsh.clear()
    occ = gmsh.model.occ
    if dimension == 3:
        boxes = [(3, occ.addBox(0, 0, 0, 2, 1, 1)), (3, occ.addBox(2, 0, 0, 1, 1, 1))]
    else:
        boxes = [(2, occ.addRectangle(0, 0, 0, 2, 1)), (2, occ.addRectangle(2, 0, 0, 1, 1))]
    occ.fragment(boxes[:1], boxes[1:])
    occ.synchronize()
    centre = lambda entity: occ.getCenterOfMass(*entity)[0]
    parts = sorted(gmsh.model.getEntities(dimension), key=centre)
    base = [tag for d, tag in gmsh.model.getEntities(dimension - 1) if centre((d, tag)) < 1e-9]
    for part, group in zip(parts, GROUPS):
        gmsh.model.addPhysicalGroup(dimension, [part[1]], name=group)
    gmsh.model.addPhysicalGroup(dimension - 1, base, name="base")
    gmsh.option.setNumber("Mesh.SecondOrderIncomplete", hexahedra)
    gmsh.option.setNumber("Mesh.MeshSizeMin", 1)
    gmsh.option.setNumber("Mesh.MeshSizeMax", 1)
    if hexahedra:
        for curve in gmsh.model.getEntities(1):
            gmsh.model.mesh.setTransfiniteCurve(curve[1], 2)
        for surface in gmsh.model.getEntities(2):
            gmsh.model.mesh.setTransfiniteSurface(surface[1])
            gmsh.model.mesh.setRecombine(*surface)
        for volume in gmsh.model.getEntities(3):
            gmsh.model.mesh.setTransfiniteVolume(volume[1])
    gmsh.model.mesh.generate(dimension)
    gmsh.model.mesh.setOrder(2)
    for ending in ["msh", "inp"]:
        gmsh.write(f"{name}.{ending}")


def sets(name):
    """The mesh as meshio reads it, without the arrays of Gmsh's own."""
    found = meshio.read(f"{name}.msh")
    found.cell_sets.pop("gmsh:bounding_entities", None)
    found.cell_data, found.point_data, found.field_data = {}, {}, {}
    return found


def rewrite(source, target, encoded, compressor):
    """The same VTU file as VTK's own writer leaves it, numbers appended."""
    reader, writer = vtk.vtkXMLUnstructuredGridReader(), vtk.vtkXMLUnstructuredGridWriter()
    reader.SetFileName(source)
    reader.Update()
    writer.SetInputData(reader.GetOutput())
    writer.SetFileName(target)
    writer.SetDataModeToAppended()
    writer.SetEncodeAppendedData(encoded)
    writer.SetCompressorType(compressor)
    writer.SetHeaderTypeToUInt64() if encoded else writer.SetHeaderTypeToUInt32()
    writer.Write()


gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
mesh("F_tets", 0, 3)
mesh("F_hexes", 1, 3)
mesh("F_plane", 0, 2)
sets("F_tets").write("F_tets_ascii.vtu", binary=False)
sets("F_hexes").write("F_hexes_zlib.vtu")
sets("F_plane").write("F_plane_base64.vtu", compression=None)
sets("F_hexes").write("F_hexes_meshio.inp")
rewrite("F_tets_ascii.vtu", "F_tets_appended.vtu", 0, vtk.vtkXMLWriter.ZLIB)
rewrite("F_hexes_zlib.vtu", "F_hexes_appended.vtu", 1, vtk.vtkXMLWriter.NONE)
