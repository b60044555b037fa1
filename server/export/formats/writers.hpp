#pragma once
// The writers of the file formats, and a table of them. Each source file has the name of its format.

#include <array>
#include <string>
#include <string_view>

#include "export/drawing/drawing.hpp"
#include "export/formats/format.hpp"

namespace oval4d::exports {

// --- Writers of mesh formats. Each of them throws ExportRefused if the time limit is exceeded or a stop was requested.

/// Returns a binary glTF 2.0 file in meters. It has a node for each body, and vertex colors. On surfaces of fields,
/// normals vary smoothly, except across sharp edges (see smoothNormals()). Throws std::runtime_error if the library
/// tinygltf fails.
std::string glb(const MeshesToWrite& meshes);

/// Returns a Wavefront OBJ file in millimeters. Each body is an object, in which the triangles of each cell form a
/// group.
std::string obj(const MeshesToWrite& meshes);

/// Returns a binary little-endian PLY file in millimeters, with all bodies in one mesh. Each triangle has a color. For
/// fields, each point has a color instead, and the value of the function as the property `value`, which is NaN at the
/// points of labels. Coordinates are 32-bit floats or, if MeshesToWrite::hasDoubles is true, 64-bit floats.
std::string ply(const MeshesToWrite& meshes);

/// Returns an OpenSCAD program in millimeters. It has a module for each body (body_1 and so on), which makes a
/// polyhedron with the color PlacedMesh::color. At its end, the program calls each module at the position of its body.
/// Comments contain the names of the object and of the bodies.
std::string scad(const MeshesToWrite& meshes);

/// Returns a binary STL file in millimeters, with all bodies in one mesh.
std::string stl(const MeshesToWrite& meshes);

/// Returns a 3MF file in millimeters, with an object for each body. Throws std::runtime_error if the library lib3mf
/// fails.
std::string threeMf(const MeshesToWrite& meshes);

/// Returns an X3D 3.3 file in the XML encoding (ISO/IEC 19775-1 and 19776-1), in meters. It has a Shape for each body,
/// and a color for each triangle or, for fields, for each point.
std::string x3d(const MeshesToWrite& meshes);

// --- Writers of data formats

/// Returns a CSV file. Lengths, areas and volumes are in the units of the object. w and centroids are in the
/// coordinates of the object's file (see ObjectInfo::originInFile).
///
/// For a field, the file has one row per slice and level, in the order of the levels: n (the index of the hyperplane),
/// w, the level if there are several, the volume, the area of the level set without caps, the centroid (empty if there
/// is no volume), the number of connected components, the Euler characteristic of the surface (see
/// slicing::SurfaceMeasurements), and the mean of the second function on the surface, if there is a second function.
/// Computes the surfaces with slicing::ClosedSurfaceSlicer, and ignores the surfaces of the scene. For other objects,
/// the file has one row per slice: n, w, the numbers of vertices, edges and faces, the volume, the area, and the
/// centroid (empty if the slice is empty).
///
/// For ExportContentsKind::critical, the file has one row per critical value of w instead. For a field (see
/// slicing::findCriticalSections()), the row contains w, the name of the change, the level, the numbers of components
/// and of cavities and the Euler characteristic below and above w, and slicing::CriticalSections::tolerance. For other
/// objects, the row contains w and the number of the object's vertices at this w. Throws ExportRefused if a limit is
/// exceeded or a stop was requested.
std::string measurementsCsv(const SceneToWrite& source);

/// Returns the rotated object (a polytope, surface or point cloud) as a 4OFF file, in the units and coordinates of the
/// object's file (see ObjectInfo::originInFile). Importing the file gives the rotated polytope or surface. The file of
/// a point cloud contains only vertices.
std::string off(const SceneToWrite& source);

/// Returns a scene for POV-Ray 3.7. Its image shows the slices of the picture with their faces, bars, balls, surfaces
/// and labels, and the projection if the picture shows it. Camera, light and background are those of the picture.
/// Lengths are in world units, and coordinates are right-handed. Adds a warning if the picture has fog. Throws
/// ExportRefused if a limit is exceeded or a stop was requested.
std::string pov(const SceneToWrite& source);

/// Returns a VTK XML file of the type ImageData. It contains the values of a field in slice 0, on a regular lattice in
/// the bounding box of the domain's slice, in the object's own units. The value is NaN at points outside the domain.
/// The object must be a field, and the contents must be ExportContentsKind::focus. Throws ExportRefused if the slice is
/// empty, if a limit is exceeded, or if a stop was requested.
std::string vti(const SceneToWrite& source);

/// Returns a VTK XML file of the type PolyData, in the object's own units. For ExportContentsKind::oval, the slices
/// have the places of the picture. The file contains:
/// - for a polytope: the faces of the slices, with the array `cell`;
/// - for a surface: the edges of the slices; for a point cloud: the points;
/// - for a field: the surfaces of all levels. Each point has the arrays `value`, `second_value` (if there is a second
///   function), `normals` and `growth` (see slicing::SliceSurface; NaN if infinite). Each triangle has the arrays
///   `level` and `cap`.
/// Each face, edge, point or triangle has the arrays `n` (the index of its hyperplane) and `w` (the w of this
/// hyperplane in the coordinates of the object's file). Coordinates are 32-bit floats or, if SceneToWrite::exact is
/// true, 64-bit floats. Adds a warning about slices that contribute nothing to the file. Throws ExportRefused if a
/// limit is exceeded or a stop was requested.
std::string vtp(const SceneToWrite& source);

// --- Writers of figure formats

/// Returns the drawing as a PDF 1.4 document. Its only page has the size of the drawing on paper. Throws
/// std::runtime_error if the width or the height is not from 3 to 14,400 points (1/72 inch), or if there is not enough
/// memory.
std::string pdf(const Drawing& drawing);

/// Returns the drawing as an SVG 1.1 image.
std::string svg(const Drawing& drawing);

/// Returns the drawing as an environment `tikzpicture` for LaTeX with the package tikz. The text is ASCII, except for
/// the title in the first line, a comment. Shapes are cut at 16,000 points, because lengths in TeX are less than 16,384
/// points.
std::string tikz(const Drawing& drawing);

// --- The table of writers

/// The name of a format, and its writer: one of the three functions, `ofBodies`, `ofScene` or `ofDrawing`. The other
/// two are null. `readsSurfaces`, `showsPicture` and `keepsDoubles` mean the same as in Format.
struct FormatWriterRow {
    std::string_view name;
    std::string (*ofBodies)(const MeshesToWrite&) = nullptr;
    std::string (*ofScene)(const SceneToWrite&) = nullptr;
    std::string (*ofDrawing)(const Drawing&) = nullptr;
    bool readsSurfaces = false, showsPicture = false, keepsDoubles = false;
};

/// All writers. Each writer belongs to the row of protocol/export_formats.json with the same name.
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
