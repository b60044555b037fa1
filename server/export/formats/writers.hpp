#pragma once
// The writers of the file formats, and the table of them. The source file of each writer is named after its format.

#include <array>
#include <string>
#include <string_view>

#include "export/drawing/drawing.hpp"
#include "export/formats/format.hpp"

namespace oval4d::exports {

// --- Formats of bodies. Each writer throws ExportRefused if the time limit is exceeded or a stop is requested.

/// Returns a binary glTF 2.0 file in meters, with a node for each body and with vertex colors. The normals of the
/// surfaces of fields vary smoothly, except across sharp edges (see smoothNormals()). Throws std::runtime_error if
/// tinygltf fails.
std::string glb(const MeshesToWrite& meshes);

/// Returns a Wavefront OBJ file in millimeters. Each body is an object; in it, the triangles of each cell form a group.
std::string obj(const MeshesToWrite& meshes);

/// Returns a binary little-endian PLY file in millimeters, with all bodies in one mesh and a color for each triangle.
/// For fields, not the triangles but the points have colors, and each point has the value of the function as the
/// property `value`; the value is NaN at the points of labels. The coordinates are 32-bit floats or, if
/// MeshesToWrite::hasDoubles is true, 64-bit floats.
std::string ply(const MeshesToWrite& meshes);

/// Returns an OpenSCAD program in millimeters. It has a module for each body, body_1 and so on, which makes a
/// polyhedron in the color of the body, PlacedMesh::color; at the end, it calls each module at the position of its
/// body. Comments contain the names of the object and of the bodies.
std::string scad(const MeshesToWrite& meshes);

/// Returns a binary STL file in millimeters, with all bodies in one mesh.
std::string stl(const MeshesToWrite& meshes);

/// Returns a 3MF file in millimeters, with an object for each body. Throws std::runtime_error if lib3mf fails.
std::string threeMf(const MeshesToWrite& meshes);

/// Returns an X3D 3.3 file in the XML encoding (ISO/IEC 19775-1 and 19776-1), in meters, with a Shape for each body and
/// a color for each triangle or, for fields, for each point.
std::string x3d(const MeshesToWrite& meshes);

// --- Formats of data.

/// Returns a CSV file. Lengths, areas and volumes are in the units of the object.
///
/// For a field, the file has one row per slice and level, in the order of the levels: n (the index of the hyperplane),
/// w, the level if there are several, volume, area of the level set without caps, centroid (empty if there is no
/// volume), number of connected components, Euler characteristic of the surface (see slicing::SurfaceMeasurements), and
/// the mean of the second function on the surface if there is such a function. Computes the surfaces anew by
/// slicing::ClosedSurfaceSlicer, and ignores those of the scene. For ExportContentsKind::critical, the file has instead
/// one row per critical value of w (see slicing::findCriticalSections()): w, the name of the change, the level, the
/// numbers of components and of cavities and the Euler characteristic below and above w, and
/// slicing::CriticalSections::tolerance. Throws ExportRefused if a limit is exceeded or a stop is requested.
///
/// For other objects, the file has one row per slice: n, w, the numbers of vertices, edges and faces, volume, area, and
/// centroid (empty if the slice is empty). w and the centroid are in the coordinates of the object's file (see
/// ObjectInfo::originInFile). For ExportContentsKind::critical, the file has instead one row per critical value of w,
/// at which the combinatorial type of the slices changes: w, and the number of the object's vertices there.
std::string measurementsCsv(const SceneToWrite& source);

/// Returns the rotated object, a polytope, surface or point cloud, as a 4OFF file in the units and coordinates of the
/// object's file (see ObjectInfo::originInFile). Importing the file of a polytope or surface gives the rotated object;
/// the file of a point cloud has vertices only.
std::string off(const SceneToWrite& source);

/// Returns a scene of POV-Ray 3.7, whose image has the slices of the picture with their faces, bars, balls, surfaces
/// and labels, the projection if the picture shows it, and the camera, light and background of the picture. Lengths are
/// in world units; the coordinates are right-handed. Adds a warning if the picture has fog. Throws ExportRefused if a
/// limit is exceeded or a stop is requested.
std::string pov(const SceneToWrite& source);

/// Returns a VTK XML file of the type ImageData: the values of a field in slice 0, on a regular lattice that fills the
/// bounding box of the domain's slice, in the object's own units. Points of the lattice outside the domain have the
/// value NaN. The object must be a field, and the contents must be ExportContentsKind::focus. Throws ExportRefused if
/// the slice is empty, if a limit is exceeded, or if a stop is requested.
std::string vti(const SceneToWrite& source);

/// Returns a VTK XML file of the type PolyData, in the object's own units. For ExportContentsKind::oval, the slices are
/// placed as in the picture. For a polytope, the file has the faces of the slices, with the array `cell`; for a
/// surface, the edges of the slices; for a point cloud, the points. For a field, it has the surfaces of all levels,
/// with the arrays `value`, `second_value` (if there is a second function), `normals` and `growth` (see
/// slicing::SliceSurface) for each point, and `level` and `cap` for each triangle. The arrays `n` and `w` have, for
/// each face, edge, point or triangle, the index n of the hyperplane of its slice, and the w of this hyperplane in the
/// coordinates of the object's file. Infinite growth is written as NaN. The points are 32-bit floats or, if
/// SceneToWrite::exact is true, 64-bit floats. Adds a warning about slices without any of these faces, edges, points or
/// triangles. Throws ExportRefused if a limit is exceeded or a stop is requested.
std::string vtp(const SceneToWrite& source);

// --- Formats of drawings.

/// Returns the drawing as a PDF 1.4 document of one page, which has the size of the drawing on paper. Width and height
/// must be from 3 to 14,400 points (1/72 inch). Throws std::runtime_error if they are not, or if there is not enough
/// memory.
std::string pdf(const Drawing& drawing);

/// Returns the drawing as an SVG 1.1 image.
std::string svg(const Drawing& drawing);

/// Returns the drawing as an environment `tikzpicture` for LaTeX with the package tikz, in ASCII but for the title in
/// its first line, a comment. Shapes are cut at 16,000 points, because TeX has no lengths of 16,384 points or more.
std::string tikz(const Drawing& drawing);

// --- All of them.

/// The name of a format, and the function that writes it, from bodies, a scene or a drawing; the other two functions
/// are null. `readsSurfaces`, `showsPicture` and `keepsDoubles` have the meaning of the members of Format with these
/// names.
struct FormatWriterRow {
    std::string_view name;
    std::string (*ofBodies)(const MeshesToWrite&) = nullptr;
    std::string (*ofScene)(const SceneToWrite&) = nullptr;
    std::string (*ofDrawing)(const Drawing&) = nullptr;
    bool readsSurfaces = false, showsPicture = false, keepsDoubles = false;
};

/// All writers. Each has a row of protocol/export_formats.json with the same name.
inline constexpr auto kWriters =
    std::to_array<FormatWriterRow>({{.name = "3mf", .ofBodies = threeMf},
                                    {.name = "csv", .ofScene = measurementsCsv},
                                    {.name = "glb", .ofBodies = glb},
                                    {.name = "obj", .ofBodies = obj, .keepsDoubles = true},
                                    {.name = "off", .ofScene = off},
                                    {.name = "pdf", .ofDrawing = pdf},
                                    {.name = "ply", .ofBodies = ply, .keepsDoubles = true},
                                    {.name = "pov", .ofScene = pov, .readsSurfaces = true, .showsPicture = true},
                                    {.name = "scad", .ofBodies = scad},
                                    {.name = "stl", .ofBodies = stl},
                                    {.name = "svg", .ofDrawing = svg},
                                    {.name = "tikz", .ofDrawing = tikz},
                                    {.name = "vti", .ofScene = vti},
                                    {.name = "vtp", .ofScene = vtp, .readsSurfaces = true},
                                    {.name = "x3d", .ofBodies = x3d}});

}  // namespace oval4d::exports
