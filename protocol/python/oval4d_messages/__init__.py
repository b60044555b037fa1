"""Types for the messages of protocol/README.md: dicts whose members type checkers and editors know.
Generated from the schemas in protocol/schema/ by tests/lint --fix.
"""

from collections.abc import Sequence
from typing import Literal, Optional, TypedDict, Union


class _Address(TypedDict):
    type: Literal["address"]
    # The query of an address, without the question mark, percent-encoded, such as `polytope=24-cell&rotate=xw:0.3`. The
    # parameters are those of `frame.png`; `width`, `height` and `token` are ignored.
    query: str


class Address(_Address, total=False):
    """To the server: shows the view that the query of an address describes, as one undo step. From the server: the
    query that describes the view of the session, as the answer to a get."""
    # Chosen by the client; the answer or error has the same id.
    id: float


# The kind of element. The points of a point cloud are vertices.
ElementKind = Literal["vertex", "edge", "face", "cell"]


class AtHighlight(TypedDict):
    """The element at the point that is nearest to the viewer, as set takes it; null if there is none."""
    # The kind of element. The points of a point cloud are vertices.
    element: ElementKind
    # The element, counted from 0 among those of its kind.
    number: int


# Where the element or the surface is shown.
_AtIn = TypedDict("_AtIn", {"in": Literal["slice", "projection", "coordinates", "matrix"]}, total=False)


class _At(TypedDict):
    type: Literal["at"]
    # The number of changes of the session's state so far.
    revision: int
    # The element at the point that is nearest to the viewer, as set takes it; null if there is none.
    highlight: Optional[AtHighlight]


class At(_At, _AtIn, total=False):
    """The answer to get with what: "at". Only type, id, revision, highlight and point are present if there is neither
    an element nor a surface of a field."""
    # The id of the request that this message answers; absent if it had none.
    id: float
    # In a slice: the index n of the hyperplane.
    slice: int
    # In a slice: w of the hyperplane, in the coordinates of the object's file.
    w: float
    # In a panel of the matrix: the point that it shows there, as set takes it.
    point: list[float]
    # The smallest w of the element's vertices.
    least_w: float
    # The largest w of the element's vertices.
    most_w: float
    # Of a vertex: its coordinates in the object's file, before the rotation; of a field, those of the box. Of a point
    # of a field: its coordinates in the box.
    place: list[float]
    # On a surface or a contour of a field: the index of its level in levels of the state.
    level: int
    # On a surface or a contour of a field: whether the point is on a cap, where the body of the level ends at the
    # boundary of the box.
    cap: bool
    # Of a point of a field: the value of the function; on a surface or a contour, but not on a cap, that of the level.
    # Absent if it has none there.
    value: float
    # Of a point of a field: the value of the second function. Absent if there is none, or if it has none there.
    second_value: float
    # Of a vertex, but of no field: its coordinates as the picture shows it, after the rotation, in the coordinates of
    # the object's file.
    coordinates: list[float]
    # The number of the element's vertices.
    vertices: int
    # Of a cell: the index of its kind in state.polytope.kinds.
    kind: int
    # Of a cell: the name of its kind. Of a 2-face: the name of its polygon, such as square, quadrilateral or pentagram.
    name: str


class _CatalogueEntry(TypedDict):
    name: str
    # "regular", "star", "uniform A4", "uniform B4", "uniform F4", "uniform H4", "other", "prism", "antiprism prism" or
    # "duoprism"; "fields" for a field; "loaded" for an object that was loaded into the session; or "data" for an array
    # in the server's data folder, which load opens by its path.
    family: str
    aliases: list[str]
    # In linear notation, such as "x4x3o3o"; empty if there is none.
    diagram: str
    # Empty if there is none.
    schlaefli: str
    # The number of vertices.
    vertices: int
    # The number of edges.
    edges: int
    # The number of 2-faces.
    faces: int
    # The number of cells.
    cells: int


class CatalogueEntry(_CatalogueEntry, total=False):
    # The order of the full symmetry group, including reflections; absent for loaded polytopes.
    symmetry_order: int


class _Catalogue(TypedDict):
    type: Literal["catalogue"]
    polytopes: list[CatalogueEntry]


class Catalogue(_Catalogue, total=False):
    """The polytopes known by name, in the order of the keys n and N. Also available at /api/v1/catalogue."""
    # The id of the request that this message answers; absent if it had none.
    id: float


class _CriticalSection(TypedDict):
    # w of the hyperplane.
    w: float
    # What happens while w increases.
    change: Literal["vertices", "appears", "vanishes", "merge", "split", "handle", "cavity"]


class CriticalSection(_CriticalSection, total=False):
    # Of a polytope, a surface or a point cloud: the number of vertices in the hyperplane.
    vertices: int
    # Of a field: the index in levels of the level whose body changes.
    level: int
    # Of a field: the number of connected components of the body below and above w.
    components: list[int]
    # Of a field: the number of cavities in the body below and above w.
    cavities: list[int]
    # Of a field: the Euler characteristic of the surface of the body below and above w.
    euler: list[int]


class _Critical(TypedDict):
    type: Literal["critical"]
    # The number of changes of the session's state when the request was received.
    revision: int
    # The smallest w of the object, or of the box of a field.
    least_w: float
    # The largest w of the object, or of the box of a field.
    most_w: float
    # The width in w to which each change has been narrowed down.
    tolerance: float
    # Of a field: changes of one level that are closer than this in w count as one; 0 for other objects.
    resolution: float
    # In the order of w.
    sections: list[CriticalSection]


class Critical(_Critical, total=False):
    """The answer to get with what: "critical"."""
    # The id of the request that this message answers; absent if it had none.
    id: float


class _Done(TypedDict):
    type: Literal["done"]
    # The number of changes of the session's state so far.
    revision: int


class Done(_Done, total=False):
    """Answers a request that has an id and took effect, if no other message answers it."""
    # The id of the request that this message answers; absent if it had none.
    id: float
    # The corrections made to a loaded file; or what an exported file lacks, such as slices that are empty. Absent if
    # there were none.
    warnings: list[str]


class _ErrorMessage(TypedDict):
    type: Literal["error"]
    # errors.json gives the meaning of each code.
    code: Literal["bad_json", "bad_message", "unknown_type", "unknown_key", "unknown_polytope", "unknown_command",
                  "bad_expression", "out_of_range", "not_a_rotation", "bad_polytope", "bad_field", "unsupported_format",
                  "no_body", "nothing_to_undo", "hello_first", "not_found", "bad_token", "too_many", "too_large",
                  "canceled", "later_version", "internal"]
    # A sentence for the user: what was wrong, where, and what is allowed.
    message: str


class ErrorMessage(_ErrorMessage, total=False):
    """A request was refused. The session is unchanged."""
    # The id of the request that this message answers; absent if it had none.
    id: float


class KeymapGroupsItem(TypedDict):
    name: str
    title: str


Plane = Literal["xy", "xz", "xw", "yz", "yw", "zw"]


class _KeyBinding(TypedDict):
    # Two characters are a sequence of two keys; each is sent in its own message. Three or more are the name of one key,
    # as in KeyboardEvent.key.
    key: str
    name: str
    action: str
    group: str
    text: str
    label: str


class KeyBinding(_KeyBinding, total=False):
    # If present, the key is recognized by this physical key, whichever character it types.
    code: str
    # Whether Ctrl must be held.
    ctrl: bool
    # Shift with this key applies the inverse rotation. If absent, the key with Shift is another entry or has no action.
    shift: Literal["inverse"]
    planes: list[Plane]
    # The quantity that the key decreases. Another key of the group increases it; the page shows the two as one control
    # with this name.
    decreases: str
    # The quantity that the key increases.
    increases: str
    # Whether the action is repeated while the button is held down.
    repeats: bool
    # The setting that is not off when the key has a visible effect; otherwise its button is disabled.
    needs: Literal["projection"]
    # The client handles this key itself; the server refuses it.
    client: bool


class _Keymap(TypedDict):
    type: Literal["keymap"]
    groups: list[KeymapGroupsItem]
    keys: list[KeyBinding]


class Keymap(_Keymap, total=False):
    """The keys, in the order of the help sheet. Also available at /api/v1/keymap."""
    # The id of the request that this message answers; absent if it had none.
    id: float


class MeasuredHighlight(TypedDict):
    """If the request asks for it: what every picture draws in the color of the highlight if this element is
    highlighted, as in `slices`. It depends only on the object."""
    # The values of `of.vertices` with which vertices are drawn in the color of the highlight, in slices and projection.
    vertices: list[int]
    # The values of `of.edges` with which edges are drawn in the color of the highlight.
    edges: list[int]
    # The element's vertices, which are marked in the parallel coordinates.
    own_vertices: list[int]


class _Measured(TypedDict):
    type: Literal["measured"]
    # The number of changes of the session's state so far.
    revision: int
    # The mean of the element's vertices; the place of a vertex.
    center: list[float]


class Measured(_Measured, total=False):
    """Answers a `measure`. Sizes and coordinates are those of the file, for a field those of the box: neither the
    orientation nor the frame of reference changes them. A region that a star encloses n times counts n times, as in the
    CSV file."""
    # The id of the request that this message answers; absent if it had none.
    id: float
    # Of an edge.
    length: float
    # Of a 2-face.
    area: float
    # Of a cell.
    volume: float
    # Of a cell: the index of its kind in `polytope.kinds` of the `state`.
    kind: int
    # Of the size of an element of a field's box, such as "m² s", if the units of the axes along which it extends are
    # known.
    unit: str
    # Of a 2-face: the name of its polygon, such as square, quadrilateral or pentagram.
    name: str
    # If the request asks for it: what every picture draws in the color of the highlight if this element is highlighted,
    # as in `slices`. It depends only on the object.
    highlight: MeasuredHighlight
    # Together with `highlight`: the least and the greatest w of the element's vertices in the present orientation and
    # frame of reference.
    range: list[float]


class _Pong(TypedDict):
    type: Literal["pong"]
    # The threads that slice and draw pictures.
    workers: int
    # The pictures of all clients that wait for one of these threads.
    waiting: int
    # The running time of all pictures that have ended, in seconds, added over all threads.
    busy: float
    # The time of a clock that never goes back, in seconds from an arbitrary start.
    time: float


class Pong(_Pong, total=False):
    """Answers a `ping`. Between two pongs, the threads were busy for the fraction Δ`busy` / (`workers` · Δ`time`) of
    the time."""
    # The id of the request that this message answers; absent if it had none.
    id: float


class StatePolytopeKindsItem(TypedDict):
    name: str
    # The number of cells of this kind.
    cells: int
    # The color of this kind when the faces are colored by kind.
    color: int


class _StatePolytope(TypedDict):
    # The kinds of cells, the rarest first; a kind is numbered by its index here.
    kinds: list[StatePolytopeKindsItem]
    name: str
    # The number of vertices.
    vertices: int
    # The number of edges.
    edges: int
    # The number of 2-faces.
    faces: int
    # The number of cells.
    cells: int


class StatePolytope(_StatePolytope, total=False):
    """The object that is shown."""
    # The point of the file's coordinates about which the object turns, in the frame of reference. Absent if it is the
    # origin.
    center: list[float]


class _StateSlices(TypedDict):
    # The number of slices; if set alone, the span (count − 1) · spacing stays the same.
    count: int
    # δ, the distance between neighboring hyperplanes, in the polytope's units.
    spacing: float
    # f, the index n of the focus slice, which lies in the hyperplane w = offset + n · spacing.
    focus: int
    # w of the hyperplane n = 0, measured from the center.
    offset: float


class StateSlices(_StateSlices, total=False):
    # w of the focus slice, in the coordinates of the object's file: sets `focus` and `offset` such that the offset is
    # at most half of the spacing.
    w: float


class _StateShown(TypedDict):
    # Whether faces are drawn.
    faces: bool
    # Whether bars are drawn at edges.
    bars: bool
    # Whether balls are drawn at vertices.
    balls: bool
    # Whether the parallel coordinates are drawn.
    coordinates: bool


class StateShown(_StateShown, total=False):
    """The parts of a picture that can be shown or hidden: the object "shown" in set, state and slices."""
    # Whether the w of each slice is written under it.
    labels: bool
    # Whether the projection of the whole polytope shows the 2-faces that bound its cells, or those of a surface.
    cells: bool
    # Whether the projection shows what the 4-D eye cannot see: elements that belong only to cells turned away from it
    # and, of a polytope that is not convex, vertices, parts of edges and whole 2-faces behind other cells. Hidden kinds
    # of cells hide nothing: the eye sees what is behind them.
    back: bool
    # Whether the projection shows the sections of all hyperplanes, not only that of the focus slice.
    sections: bool


class StateCamera(TypedDict):
    """How the viewer has moved the camera from its initial position. Not part of the undo history."""
    # The rotation to the right about the vertical axis, in radians.
    azimuth: float
    # The rotation upward, in radians.
    elevation: float
    # The magnification; 1 initially.
    zoom: float


Interval = list[float]

# The domain. The object's origin is its center.
Box = list[Interval]


class _Resolution(TypedDict):
    # The level that is shown; 0 is the finest.
    level: int
    # How many levels the image has.
    levels: int


class Resolution(_Resolution, total=False):
    """Present only for a multiscale image in the data folder of which a region or a coarser level is or was shown."""
    # Present, and true, if a finer level is to replace this one, as long as a client is connected.
    refining: bool


class AxisUnits(TypedDict, total=False):
    """The units of the coordinates in `box`, as the file of an array states them; those that are not known are absent.
    At most 64 bytes each."""
    x: str
    y: str
    z: str
    w: str


class Quantity(TypedDict, total=False):
    """As the file of an array states it; what is not known is absent. At most 64 bytes each."""
    # Such as "temperature".
    name: str
    # Such as "K".
    unit: str


class _ColoringValues(TypedDict):
    # The range of the values on the box, without rare values far from the others. If 0 is in its middle four fifths,
    # the scale is symmetric to 0.
    range: list[float]
    # The colors of nine values, from one end of the scale to the other at equal distances.
    colors: list[int]


class ColoringValues(_ColoringValues, total=False):
    """Present if there is a second function, or if the color or the caps show values."""
    # Present if the second function is a formula.
    formula: str
    # Present if the second function is an array.
    variable: str
    # Of the second function, if it is an array.
    quantity: Quantity


class _FieldDefinition(TypedDict):
    # The domain. The object's origin is its center.
    box: Box


class FieldDefinition(_FieldDefinition, total=False):
    """If it has a `formula`, the field called `polytope` is loaded first, as by `load`, unless the session has it;
    otherwise ignored."""
    # The function with the values of its constants. Absent for an array.
    formula: str
    # Absent for a formula.
    shape: list[int]
    # Absent for a formula.
    range: list[float]
    # Present, and true, if the array is too large to read all of it.
    estimated: bool
    # The region of the array that was asked for. Present only for a part of an array in the data folder that was loaded
    # with a region.
    region: Box
    # Present only for a multiscale image in the data folder of which a region or a coarser level is or was shown.
    resolution: Resolution
    # The units of the coordinates in `box`, as the file of an array states them; those that are not known are absent.
    # At most 64 bytes each.
    units: AxisUnits
    # As the file of an array states it; what is not known is absent. At most 64 bytes each.
    quantity: Quantity
    # Present if there is a second function, or if the color or the caps show values.
    values: ColoringValues


class _CommonCoordinate(TypedDict):
    # Its axis in `box`.
    axis: Literal["x", "y", "z", "w"]
    # Its value in the focus slice.
    value: float


class CommonCoordinate(_CommonCoordinate, total=False):
    """Present for a field if all points of the focus slice have one coordinate in `box` in common, such as the time:
    unless a rotation or the frame of reference mixes the axes."""
    # Absent if it is not known.
    unit: str


class _StateSection(TypedDict):
    # w of the focus slice.
    w: float
    # What the focus slice is, such as "icosahedron"; empty if it has no name.
    name: str
    # The convex hull of the polytope's vertices in the hyperplane, as in Coxeter's tables of sections; empty if it has
    # no name.
    vertices: str


class StateSection(_StateSection, total=False):
    """The section of the focus hyperplane. Names are those of regular polygons, Platonic, Archimedean, Catalan and
    Kepler–Poinsot solids, cuboids, and right prisms, antiprisms, pyramids and bipyramids over regular polygons."""
    # Present for a field if all points of the focus slice have one coordinate in `box` in common, such as the time:
    # unless a rotation or the frame of reference mixes the axes.
    coordinate: CommonCoordinate


# What is shown: all slices in the oval; only the focus slice (single); the focus slice beside the matrix of planar
# sections; or all slices at the same size, in a straight row in order of w from the left (strip), in a straight column
# with the largest w at the top (column), or in as many rows as make them largest, in order of w from left to right and
# from top to bottom (grid).
View = Literal["oval", "single", "matrix", "strip", "column", "grid"]

# What the colors of faces show: see the list below this table; for the surfaces of fields, see Fields.
Coloring = Literal["cell", "kind", "w", "plain", "light", "growth", "value"]

# The background of pictures; the other colors are chosen for it. See Backgrounds.
Background = Literal["auto", "dark", "light", "white", "transparent"]

# For fields only: the caps of the surfaces, where the boundary of the box cuts through the body: in the color of the
# surface, colored by value, or not drawn. Exported bodies have caps in any case.
Caps = Literal["plain", "value", "open"]

# For fields only: whether the bodies are where the function is below a level, or above it. A change of the object sets
# it to `below` for a formula and `above` for an array.
Inside = Literal["below", "above"]


class _FogControlPoint(TypedDict):
    value: float
    opacity: float


class FogControlPoint(_FogControlPoint, total=False):
    color: int


# The projection of the whole polytope in the middle of the oval: none, from an eye on the positive w axis, or parallel
# to the w axis.
Projection = Literal["off", "perspective", "orthogonal"]


class StateHighlight(TypedDict):
    """The element that is drawn in another color, in slices, projection and parallel coordinates; null if there is
    none. A change of the polytope sets it to null."""
    # The kind of element. The points of a point cloud are vertices.
    element: ElementKind
    # The element, counted from 0 among those of its kind.
    number: int


class TurnObject(TypedDict):
    """The last rotation, for `.` and the space bar; null changes nothing."""
    # Each plane at most once. R_ab turns the +a axis toward the +b axis. In several planes the polytope turns at the
    # same time: two perpendicular planes (xy and zw, xz and yw, xw and yz) give a double rotation, planes with a common
    # axis a rotation in oblique planes.
    planes: list[Plane]
    # One angle for each plane, in radians.
    angles: list[float]


# The last rotation, for `.` and the space bar; null changes nothing.
Turn = Optional[TurnObject]


class _State(TypedDict):
    type: Literal["state"]
    # The number of changes of the session's state so far.
    revision: int
    # The object that is shown.
    polytope: StatePolytope
    slices: StateSlices
    # The focus point, through which the planes of the matrix view pass, in the coordinates of the object's file. Its w
    # is that of the focus slice.
    point: list[float]
    # Whether something moves without further commands: the polytope turns continuously, an element is on its way to +w,
    # or the focus plays.
    moving: bool
    # Which parts are drawn.
    shown: StateShown
    # How the viewer has moved the camera from its initial position. Not part of the undo history.
    camera: StateCamera
    # The section of the focus hyperplane. Names are those of regular polygons, Platonic, Archimedean, Catalan and
    # Kepler–Poinsot solids, cuboids, and right prisms, antiprisms, pyramids and bipyramids over regular polygons.
    section: StateSection
    # How much space a unit of w is worth, if w is time: the object's w is multiplied by it. See Frames of reference.
    pace: float
    # The velocity with which the observer moves, in units of x, y and z per unit of the object's own w: whatever moves
    # with this velocity appears at rest.
    follow: list[float]
    # The velocity of the observer to whose rest frame a Lorentz boost leads, where 1 is the speed of light in units of
    # x, y and z per unit of w, after `pace` has scaled w.
    boost: list[float]
    # The matrix M, where v' = M v maps the polytope's own coordinates to the rotated ones: a rotation matrix to within
    # 1e-6, else `not_a_rotation`.
    orientation: list[list[float]]
    # α: the angle of the keys 2 … 7, and the first angle of the keys r, t and y.
    alpha: float
    # β: the second angle of the keys r, t and y.
    beta: float
    # The step by which the keys k, j, K and J change α and β.
    step: float
    # What is shown: all slices in the oval; only the focus slice (single); the focus slice beside the matrix of planar
    # sections; or all slices at the same size, in a straight row in order of w from the left (strip), in a straight
    # column with the largest w at the top (column), or in as many rows as make them largest, in order of w from left to
    # right and from top to bottom (grid).
    view: View
    # Continuous turning: in each second the object turns by 6 times the angles of the last rotation, in 60 steps; each
    # step is a revision.
    turning: bool
    # Whether the focus moves from the lowest w of the object to the highest and back, again and again, in at most 60
    # steps per second; each step is a revision. Ended by whatever else sets `focus`, `offset`, `w` or `point`, by
    # another object, and by `reset`.
    playing: bool
    # The speed of `playing`: at 1, the focus moves from one end to the other in 8 seconds, at 2 in 4 seconds.
    speed: float
    # What the colors of faces show: see the list below this table; for the surfaces of fields, see Fields.
    color: Coloring
    # The background of pictures; the other colors are chosen for it. See Backgrounds.
    background: Background
    # The factor by which the radii of all balls and bars are multiplied in slices, in the projection and in drawings.
    # Exported bodies and the matrix of planar sections stay as they are.
    thickness: float
    # The factor by which the opacity of translucent faces is multiplied in slices, in the projection and in drawings;
    # they become at most opaque. Faces in slices of nonconvex polytopes are opaque in any case. The surfaces of fields
    # and the matrix of planar sections stay as they are.
    opacity: float
    # The projection of the whole polytope in the middle of the oval: none, from an eye on the positive w axis, or
    # parallel to the w axis.
    projection: Projection
    # The w of the eye of the perspective projection, in circumradii.
    eye: float
    # Cells of these kinds are not drawn, nor are bars and balls that belong to no other cell. If only one of `hidden`
    # and `faded` is set, its kinds are removed from the other; a kind in both is hidden. A change of the polytope
    # empties both.
    hidden: list[int]
    # Cells of these kinds are drawn faintly.
    faded: list[int]
    # The element that is drawn in another color, in slices, projection and parallel coordinates; null if there is none.
    # A change of the polytope sets it to null.
    highlight: Optional[StateHighlight]
    # The last rotation, for `.` and the space bar; null changes nothing.
    last: Turn


class State(_State, total=False):
    """Everything that determines a picture except its size. Sent back as a set, it restores the picture. Each frame
    contains it in the iTXt chunk "oval4d"."""
    # The id of the request that this message answers; absent if it had none.
    id: float
    # The serial number of the object that is shown, as it was built or loaded: states with equal numbers show the same
    # object, only with other settings. Absent in pictures that belong to no session.
    object_serial: int
    # Present if the surfaces of a field are coarser than usual, because it turns or changes quickly. A picture of the
    # same revision without it follows once the field rests.
    draft: Literal[True]
    # Present for fields only.
    field: FieldDefinition
    # For fields only: the caps of the surfaces, where the boundary of the box cuts through the body: in the color of
    # the surface, colored by value, or not drawn. Exported bodies have caps in any case.
    caps: Caps
    # For fields only: the values at which surfaces are shown. A change of the object sets it to the object's own level.
    levels: list[float]
    # For fields only: whether the bodies are where the function is below a level, or above it. A change of the object
    # sets it to `below` for a formula and `above` for an array.
    inside: Inside
    # For fields only: the transfer function of the fog that fills the slices: the opacity of a layer as thick as the
    # circumradius, and the color, of each value; linear between the points, and constant beyond. An empty array
    # (initially) means no fog. A change of the object empties it.
    fog: list[FogControlPoint]


class Limits(TypedDict):
    """The limits of the server, as the section on limits of README.md explains them."""
    message: int
    request_bytes: int
    upload: int
    field_bytes: int
    depth: int
    requests_per_second: int
    min_side: int
    max_width: int
    max_height: int
    max_pixels: int
    slice_edges: int
    file_triangles: int
    file_bytes: int
    file_time: float
    slices: int
    shown_timeout: float


class _Welcome(TypedDict):
    type: Literal["welcome"]
    # The name of the session, for the path /ws/{session}.
    session: str
    # Gives access to the session; keep it secret.
    token: str
    # The protocol version.
    protocol: int
    server: str
    # The limits of the server, as the section on limits of README.md explains them.
    limits: Limits


class Welcome(_Welcome, total=False):
    """Answers hello with the session and the limits of the server."""
    # The id of the request that this message answers; absent if it had none.
    id: float


Answer = Union[Address, At, Catalogue, Critical, Done, ErrorMessage, Keymap, Measured, Pong, State, Welcome]


class _CommandRequest(TypedDict):
    type: Literal["command"]
    # The command, with or without the leading `:`.
    line: str


class CommandRequest(_CommandRequest, total=False):
    """A line such as "polytope 24-cell", "set slices=31" or "rotate xw,yz pi/8 pi/sqrt(3)-pi/8"."""
    # Chosen by the client; the answer or error has the same id.
    id: float


class GetRequestHighlight(TypedDict):
    """The element that is highlighted in `slices` or a `frame`; by default that of the session."""
    # The kind of element. The points of a point cloud are vertices.
    element: ElementKind
    # The element, counted from 0 among those of its kind.
    number: int


class _GetRequest(TypedDict):
    type: Literal["get"]
    # What to get.
    what: Literal["state", "slices", "frame", "at", "file", "critical", "catalogue", "keymap", "address"]


class GetRequest(_GetRequest, total=False):
    """Answered by the requested message with the same id; a frame or a file is a binary message followed by done."""
    # Chosen by the client; the answer or error has the same id.
    id: float
    # The width of `slices`, of a `frame`, or of the picture for `at`; together with `height`. By default the size in
    # `hello`.
    width: int
    # The height of `slices`, of a `frame`, or of the picture for `at`; together with `width`. By default the size in
    # `hello`.
    height: int
    # The background of `slices` or a `frame`; by default that of the session.
    background: Background
    # The element that is highlighted in `slices` or a `frame`; by default that of the session.
    highlight: Optional[GetRequestHighlight]
    # A coordinate of the point, for `at`.
    x: float
    # A coordinate of the point, for `at`.
    y: float
    # For `at`, instead of `x` and `y`: a point of a field, whose values are asked, after the rotation and in the
    # coordinates of the object's file, as in `set`.
    point: Sequence[float]
    # Required for a `file`; see Files.
    format: str
    # What a `file` contains: the focus slice, all slices, the highlighted element alone, the critical w, the whole
    # object in four dimensions, the parallel coordinates or the histogram of a field, the projection of the whole
    # object, or the matrix of planar sections. The first one of the format is the default.
    of: Literal["focus", "oval", "highlight", "critical", "object", "coordinates", "projection", "matrix"]
    # For a `file` with bodies: filled, or balls and bars merged into one body. `"frame"` is the former name of
    # `"skeleton"`.
    body: Literal["solid", "skeleton", "frame"]
    # In millimeters: the diameter of the polytope's circumscribed sphere, by default 60; or the width or height of a
    # drawing, whichever is larger, by default 170.
    size: float
    # For a `file` of the oval: the w of its slices, in the coordinates of the object's file, instead of those of the
    # session; at most as many as the limit `slices`. Not together with `fit`.
    at: Union[Sequence[float], str]
    # For a `file` of the oval: the number of its slices, spread evenly over the polytope's extent along w, instead of
    # those of the session. Not together with `at`.
    fit: int
    # For a `file` with bodies: whether the polytope's name and w are absent (default), engraved into a face, or on a
    # separate plate.
    label: Literal["none", "engraved", "separate"]
    # For a `file` with the surfaces of a field: whether they are cut exactly, as measured in CSV files. Other files
    # ignore it.
    exact: bool


# What follows each change: nothing, as if absent, `slices` messages, or frames.
Stream = Literal["none", "geometry", "frames"]

# The encoding of `slices` messages. `"json"` if absent.
Encoding = Literal["json", "cbor", "msgpack", "bjdata"]

# Which pictures this client gets while the `background` of the session is `auto`. `"dark"` if absent.
Scheme = Literal["dark", "light"]


class _HelloRequest(TypedDict):
    type: Literal["hello"]


class HelloRequest(_HelloRequest, total=False):
    """The first message of a connection. Sent again, it changes the stream, the encoding, the scheme and the size.
    Answered by welcome, then by state and a picture."""
    # Chosen by the client; the answer or error has the same id.
    id: float
    # What follows each change: nothing, as if absent, `slices` messages, or frames.
    stream: Stream
    # The encoding of `slices` messages. `"json"` if absent.
    encoding: Encoding
    # Which pictures this client gets while the `background` of the session is `auto`. `"dark"` if absent.
    scheme: Scheme
    # The width of frames; with geometry, of the window that the picture is laid out for. If absent, 1280, or as near to
    # it as the limits in `welcome` allow.
    width: int
    # The height of frames; with geometry, of the window that the picture is laid out for. If absent, 720, or as near to
    # it as the limits in `welcome` allow.
    height: int
    # The token of the session in the path. Required if the path names a session.
    token: str


class _KeyRequest(TypedDict):
    type: Literal["key"]
    # The key as typed, as in `KeyboardEvent.key`: `"y"`, `"K"`, `"2"`, `" "`, `"["`. For a digit key, the digit on the
    # key, even if Shift types another character. An upper-case letter means the letter with Shift.
    key: str


class KeyRequest(_KeyRequest, total=False):
    """A key press. The key table lists the keys and their actions; clients need not know the actions."""
    # Chosen by the client; the answer or error has the same id.
    id: float
    # Whether Shift is held. Ignored for keys other than letters and digits.
    shift: bool
    # Whether Ctrl is held.
    ctrl: bool


class _LoadRequest(TypedDict):
    type: Literal["load"]
    # The object's name, which must not be in the catalogue. Replaces an object loaded under the same name.
    name: str


class LoadRequest(_LoadRequest, total=False):
    """Loads an object and shows it. A set message can select it again by its name."""
    # Chosen by the client; the answer or error has the same id.
    id: float
    # The format of `data`: `"off"` is 4OFF, `"points"` and `"cloud"` are tables of points, and `"formula"` is a
    # formula, which makes a field as the others do. Required with `data`; with `path`, it may also be `"zarr"`.
    format: str
    # The text of the file, which is in Base64 if it is an array, or the formula. Absent with `path`.
    data: str
    # An array in the server's data folder, as the catalogue lists it, instead of `data`. The format may then be absent.
    path: str
    # Whether the load belongs to the undo step of the previous command, as when a slider changes a constant of a
    # formula. If a field then replaces a field, `levels`, `inside` and `fog` stay the same; if both have the same
    # circumradius, `slices` and `point` stay the same, too. False if absent.
    continues: bool
    # For a formula: the box on which it is shown, by default −2 to 2 along each axis. For an array: where its first and
    # last samples lie, by default what the file states.
    box: Box
    # The part that is read of an array in a Zarr folder of the [data folder](#the-data-folder), in the coordinates of
    # its box: the samples that cover it. Along an axis where both ends are equal, the nearest sample. The whole array
    # if it is absent.
    region: Box
    # The axes of an array's dimensions, in the order of its indices in Python, such as `"tzyx"`; see Fields. What the
    # file states if it is absent, else `"tzyx"`, or its end if there are fewer dimensions.
    axes: str
    # The variable of a NetCDF file, or the path of an HDF5 dataset. The one with the most dimensions if it is absent.
    variable: str
    # The formula of a second function, whose values color the surfaces of a formula or an array. It may use the names
    # that the first formula defines.
    values: str
    # The variable of the same file that is the second function of an array, with the same numbers of samples.
    values_variable: str
    # For polytopes, surfaces and points: the point of the file's coordinates about which the object turns and around
    # which its slices lie: `"object"`, its center; `"origin"`; or x, y, z, w. If it is absent, the center of an object
    # that is far from the origin, else the origin. See Center.
    center: Union[str, Sequence[float]]
    # Whether the moments in the file are added to the array that is loaded under this name, at the end of w, instead of
    # replacing it; false if absent. See Growing fields.
    append: bool


class _MeasureRequest(TypedDict):
    type: Literal["measure"]
    # The kind of element. The points of a point cloud are vertices.
    element: ElementKind
    # The element, counted from 0 among those of its kind.
    number: int


class MeasureRequest(_MeasureRequest, total=False):
    """Asks for a `measured`, which has the center and the length, area or volume of an element. It changes nothing.
    Errors: `out_of_range`, also if the object has no such element."""
    # Chosen by the client; the answer or error has the same id.
    id: float
    # Whether the answer also has `highlight` and `range`; false if absent.
    highlight: bool


class _PingRequest(TypedDict):
    type: Literal["ping"]


class PingRequest(_PingRequest, total=False):
    """Asks for a `pong`, which tells how busy the server is. It changes nothing."""
    # Chosen by the client; the answer or error has the same id.
    id: float


class _RandomRequest(TypedDict):
    type: Literal["random"]


class RandomRequest(_RandomRequest, total=False):
    """The new orientation is random, and all rotations are equally probable (Haar measure), so the slices are sections
    of random direction. One undo step; it ends a motion toward an element. The same `seed` gives the same orientation
    on every server, whatever the orientation was."""
    # Chosen by the client; the answer or error has the same id.
    id: float
    # Determines the orientation. If absent, the server draws a seed.
    seed: int


class _RedoRequest(TypedDict):
    type: Literal["redo"]


class RedoRequest(_RedoRequest, total=False):
    """Redoes one step that was undone. Fails with nothing_to_undo if there is none."""
    # Chosen by the client; the answer or error has the same id.
    id: float


class _ResetRequest(TypedDict):
    type: Literal["reset"]


class ResetRequest(_ResetRequest, total=False):
    """Restores the initial orientation and focus, and stops continuous turning and playing. All other settings stay the
    same."""
    # Chosen by the client; the answer or error has the same id.
    id: float


class _RotateRequest(TypedDict):
    type: Literal["rotate"]
    # Each plane at most once. R_ab turns the +a axis toward the +b axis. In several planes the polytope turns at the
    # same time: two perpendicular planes (xy and zw, xz and yw, xw and yz) give a double rotation, planes with a common
    # axis a rotation in oblique planes.
    planes: Sequence[Plane]
    # One angle for each plane, in radians.
    angles: Sequence[float]


class RotateRequest(_RotateRequest, total=False):
    """Turns through all angles at the same time. The rotation is extrinsic: it multiplies the orientation from the
    left."""
    # Chosen by the client; the answer or error has the same id.
    id: float
    # Whether the rotation belongs to the undo step of the previous command, as the parts of one gesture do; false if
    # absent.
    continues: bool


class _CellKind(TypedDict):
    name: str
    # The number of cells of this kind.
    cells: int


class CellKind(_CellKind, total=False):
    # The color of this kind when the faces are colored by kind.
    color: int


class _SettingsPolytope(TypedDict):
    name: str


class SettingsPolytope(_SettingsPolytope, total=False):
    """The polytope. Another one sets focus and offset to 0, and the spacing keeps its ratio to the circumradius."""
    # The number of vertices.
    vertices: int
    # The number of edges.
    edges: int
    # The number of 2-faces.
    faces: int
    # The number of cells.
    cells: int
    # Ignored. Allowed so that a state can be sent back as a set.
    kinds: Sequence[CellKind]
    # Ignored.
    center: Sequence[float]


class SettingsSlices(TypedDict, total=False):
    # The number of slices; if set alone, the span (count − 1) · spacing stays the same.
    count: int
    # δ, the distance between neighboring hyperplanes, in the polytope's units.
    spacing: float
    # f, the index n of the focus slice, which lies in the hyperplane w = offset + n · spacing.
    focus: int
    # w of the hyperplane n = 0, measured from the center.
    offset: float
    # w of the focus slice, in the coordinates of the object's file: sets `focus` and `offset` such that the offset is
    # at most half of the spacing.
    w: float


class ShownParts(TypedDict, total=False):
    """The parts of a picture that can be shown or hidden: the object "shown" in set, state and slices."""
    # Whether faces are drawn.
    faces: bool
    # Whether bars are drawn at edges.
    bars: bool
    # Whether balls are drawn at vertices.
    balls: bool
    # Whether the parallel coordinates are drawn.
    coordinates: bool
    # Whether the w of each slice is written under it.
    labels: bool
    # Whether the projection of the whole polytope shows the 2-faces that bound its cells, or those of a surface.
    cells: bool
    # Whether the projection shows what the 4-D eye cannot see: elements that belong only to cells turned away from it
    # and, of a polytope that is not convex, vertices, parts of edges and whole 2-faces behind other cells. Hidden kinds
    # of cells hide nothing: the eye sees what is behind them.
    back: bool
    # Whether the projection shows the sections of all hyperplanes, not only that of the focus slice.
    sections: bool


class SettingsCamera(TypedDict, total=False):
    """How the viewer has moved the camera from its initial position. Not part of the undo history."""
    # The rotation to the right about the vertical axis, in radians.
    azimuth: float
    # The rotation upward, in radians.
    elevation: float
    # The magnification; 1 initially.
    zoom: float


class SettingsHighlight(TypedDict):
    """The element that is drawn in another color, in slices, projection and parallel coordinates; null if there is
    none. A change of the polytope sets it to null."""
    # The kind of element. The points of a point cloud are vertices.
    element: ElementKind
    # The element, counted from 0 among those of its kind.
    number: int


class Settings(TypedDict, total=False):
    """The settings that set() of the client changes. Absent settings keep their values."""
    # The polytope. Another one sets focus and offset to 0, and the spacing keeps its ratio to the circumradius.
    polytope: Union[Union[str, SettingsPolytope], StatePolytope]
    # How much space a unit of w is worth, if w is time: the object's w is multiplied by it. See Frames of reference.
    pace: float
    # The velocity with which the observer moves, in units of x, y and z per unit of the object's own w: whatever moves
    # with this velocity appears at rest.
    follow: Sequence[float]
    # The velocity of the observer to whose rest frame a Lorentz boost leads, where 1 is the speed of light in units of
    # x, y and z per unit of w, after `pace` has scaled w.
    boost: Sequence[float]
    # The matrix M, where v' = M v maps the polytope's own coordinates to the rotated ones: a rotation matrix to within
    # 1e-6, else `not_a_rotation`.
    orientation: Sequence[Sequence[float]]
    # α: the angle of the keys 2 … 7, and the first angle of the keys r, t and y.
    alpha: float
    # β: the second angle of the keys r, t and y.
    beta: float
    # The step by which the keys k, j, K and J change α and β.
    step: float
    slices: Union[SettingsSlices, StateSlices]
    # The focus point, through which the planes of the matrix view pass, in the coordinates of the object's file. Its w
    # moves the focus slice as `slices.w` does, unless `slices` has `focus`, `offset` or `w`.
    point: Sequence[float]
    # What is shown: all slices in the oval; only the focus slice (single); the focus slice beside the matrix of planar
    # sections; or all slices at the same size, in a straight row in order of w from the left (strip), in a straight
    # column with the largest w at the top (column), or in as many rows as make them largest, in order of w from left to
    # right and from top to bottom (grid).
    view: View
    # Continuous turning: in each second the object turns by 6 times the angles of the last rotation, in 60 steps; each
    # step is a revision.
    turning: bool
    # Whether the focus moves from the lowest w of the object to the highest and back, again and again, in at most 60
    # steps per second; each step is a revision. Ended by whatever else sets `focus`, `offset`, `w` or `point`, by
    # another object, and by `reset`.
    playing: bool
    # The speed of `playing`: at 1, the focus moves from one end to the other in 8 seconds, at 2 in 4 seconds.
    speed: float
    # Which parts are drawn.
    shown: Union[ShownParts, StateShown]
    # How the viewer has moved the camera from its initial position. Not part of the undo history.
    camera: Union[SettingsCamera, StateCamera]
    # What the colors of faces show: see the list below this table; for the surfaces of fields, see Fields.
    color: Coloring
    # The background of pictures; the other colors are chosen for it. See Backgrounds.
    background: Background
    # The factor by which the radii of all balls and bars are multiplied in slices, in the projection and in drawings.
    # Exported bodies and the matrix of planar sections stay as they are.
    thickness: float
    # The factor by which the opacity of translucent faces is multiplied in slices, in the projection and in drawings;
    # they become at most opaque. Faces in slices of nonconvex polytopes are opaque in any case. The surfaces of fields
    # and the matrix of planar sections stay as they are.
    opacity: float
    # For fields only: the caps of the surfaces, where the boundary of the box cuts through the body: in the color of
    # the surface, colored by value, or not drawn. Exported bodies have caps in any case.
    caps: Caps
    # For fields only: the values at which surfaces are shown. A change of the object sets it to the object's own level.
    levels: Sequence[float]
    # For fields only: whether the bodies are where the function is below a level, or above it. A change of the object
    # sets it to `below` for a formula and `above` for an array.
    inside: Inside
    # For fields only: the transfer function of the fog that fills the slices: the opacity of a layer as thick as the
    # circumradius, and the color, of each value; linear between the points, and constant beyond. An empty array
    # (initially) means no fog. A change of the object empties it.
    fog: Sequence[FogControlPoint]
    # If it has a `formula`, the field called `polytope` is loaded first, as by `load`, unless the session has it;
    # otherwise ignored.
    field: FieldDefinition
    # The projection of the whole polytope in the middle of the oval: none, from an eye on the positive w axis, or
    # parallel to the w axis.
    projection: Projection
    # The w of the eye of the perspective projection, in circumradii.
    eye: float
    # Cells of these kinds are not drawn, nor are bars and balls that belong to no other cell. If only one of `hidden`
    # and `faded` is set, its kinds are removed from the other; a kind in both is hidden. A change of the polytope
    # empties both.
    hidden: Sequence[int]
    # Cells of these kinds are drawn faintly.
    faded: Sequence[int]
    # The element that is drawn in another color, in slices, projection and parallel coordinates; null if there is none.
    # A change of the polytope sets it to null.
    highlight: Optional[SettingsHighlight]
    # The last rotation, for `.` and the space bar; null changes nothing.
    last: Turn
    # Whether the change belongs to the undo step of the previous command, as the parts of one gesture do.
    continues: bool


class SetRequestSection(TypedDict, total=False):
    """Ignored. Allowed so that a state can be sent back as a set."""
    # w of the focus slice.
    w: float
    # What the focus slice is, such as "icosahedron"; empty if it has no name.
    name: str
    # The convex hull of the polytope's vertices in the hyperplane, as in Coxeter's tables of sections; empty if it has
    # no name.
    vertices: str
    # Present for a field if all points of the focus slice have one coordinate in `box` in common, such as the time:
    # unless a rotation or the frame of reference mixes the axes.
    coordinate: CommonCoordinate


class _SetRequest(TypedDict):
    type: Literal["set"]


class SetRequest(_SetRequest, Settings, total=False):
    """Sets every member that is present; the others keep their values. Changing the type of a state makes it a valid
    set."""
    # Chosen by the client; the answer or error has the same id.
    id: float
    # Ignored. Allowed so that a state can be sent back as a set.
    revision: int
    # Ignored. Allowed so that a state can be sent back as a set.
    object_serial: int
    # Ignored. Allowed so that a state can be sent back as a set.
    draft: bool
    # Ignored. Allowed so that a state can be sent back as a set.
    moving: bool
    # Ignored. Allowed so that a state can be sent back as a set.
    section: SetRequestSection


class _ShownRequest(TypedDict):
    type: Literal["shown"]
    # The revision of the picture. All earlier pictures are acknowledged, too.
    revision: int


class ShownRequest(_ShownRequest, total=False):
    """Acknowledges a picture of the stream. At any time, at most two pictures are sent but not acknowledged."""
    # Chosen by the client; the answer or error has the same id.
    id: float


class _TowardRequest(TypedDict):
    type: Literal["toward"]
    # The kind of element. The points of a point cloud are vertices.
    element: ElementKind


class TowardRequest(_TowardRequest, total=False):
    """The polytope moves there by the shortest rotation, at a quarter turn per second, as one undo step. Each step of
    the motion is a revision. The element ends in one hyperplane w = const."""
    # Chosen by the client; the answer or error has the same id.
    id: float
    # The element, counted from 0. If absent, the one that is closest to +w or, if it is already there, the next one. If
    # an element is highlighted, only those count that contain it or are contained in it, or itself if it is of this
    # kind.
    number: int
    # Whether to jump there instead of moving; false if absent.
    immediately: bool


class _UndoRequest(TypedDict):
    type: Literal["undo"]


class UndoRequest(_UndoRequest, total=False):
    """Undoes one step of the history. Fails with nothing_to_undo if there is none."""
    # Chosen by the client; the answer or error has the same id.
    id: float


Request = Union[Address, CommandRequest, GetRequest, HelloRequest, KeyRequest, LoadRequest, MeasureRequest, PingRequest,
                RandomRequest, RedoRequest, ResetRequest, RotateRequest, SetRequest, ShownRequest, TowardRequest,
                UndoRequest]

# A request that may change the session. The server answers it with `done`.
Command = Union[Address, CommandRequest, KeyRequest, LoadRequest, RandomRequest, RedoRequest, ResetRequest,
                RotateRequest, SetRequest, TowardRequest, UndoRequest]

# The types of those messages that `done` answers.
AnsweredByDone = Literal["address", "command", "key", "load", "random", "redo", "reset", "rotate", "set", "shown",
                         "toward", "undo"]
