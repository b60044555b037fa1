"""Arrays in messages: the names of their axes, their box, and the variable of a file."""

import numpy
import pytest
from array_clients import SIZE, load, state_of, unnumbered
from array_files import hdf5, netcdf, npy, quadratic
from wire import Client, Refused


async def domain_of(client):
    """Returns the extents of the box along x, y, z and w, in units of the object: those of the focus slice and of w."""
    await client.request("set", orientation=[[int(i == j) for j in range(4)] for i in range(4)],
                         slices={"count": 1, "focus": 0, "offset": 0})
    message = await client.request("get", what="slices", **SIZE)
    extents = numpy.ptp(numpy.array(message["slices"][0]["vertices"]), axis=0)
    radius = message["scene"]["circumradius"]
    half = numpy.sqrt(radius**2 - numpy.sum((extents / 2) ** 2))
    return [*extents, 2 * half]


@pytest.mark.parametrize("axes, shape, expected", [
    ("tzyx", (3, 4, 5, 9), (2, 1, 0.75, 2)),  # by default, the longest of x, y, z is 2 long, and w is as long
    ("wzyx", (3, 4, 5, 9), (2, 1, 0.75, 2)),
    ("xyzt", (9, 5, 4, 3), (2, 1, 0.75, 2)),
    ("zyx", (4, 5, 9), (2, 1, 0.75, 1)),  # without w, w is half as long as the longest
    ("tx", (3, 5), (2, 1, 1, 2)),
])
async def test_axes_name_the_dimensions(server, axes, shape, expected):
    values = numpy.random.default_rng(1).random(shape, dtype="f4")
    async with Client(server) as client:
        await load(client, "a", npy(values), axes=axes)
        assert await domain_of(client) == pytest.approx(expected, rel=1e-5)


async def test_a_box_places_an_array(server):
    async with Client(server) as client:
        await load(client, "a", npy(quadratic()), box=[[0, 4], [0, 2], [-1, 1], [0, 10]])
        assert await domain_of(client) == pytest.approx((4, 2, 2, 4), rel=1e-5)  # w is scaled to the longest axis


async def test_a_variable_is_chosen_by_its_name(server):
    async with Client(server) as client:
        await load(client, "a", hdf5(quadratic(), "run/p"), "hdf5", variable="run/p")
        await load(client, "b", netcdf(quadratic(), "p"), "netcdf", variable="p")
        for body, format_ in ((hdf5(quadratic()), "hdf5"), (netcdf(quadratic()), "netcdf")):
            with pytest.raises(Refused, match="absent") as refused:
                await load(client, "c", body, format_, variable="absent")
            assert refused.value.code in ("bad_field", "not_found", "out_of_range")


@pytest.mark.parametrize("members, code, text", [
    ({"axes": "tzy"}, "out_of_range", "4 dimensions"),
    ({"axes": "tzyy"}, "out_of_range", "different letters"),
    ({"axes": "wtyx"}, "out_of_range", "different letters"),
    ({"axes": "abcd"}, "out_of_range", "different letters"),
    ({"axes": "TZYX"}, "out_of_range", "different letters"),
    ({"axes": ""}, "bad_message", "axes"),
    ({"axes": "tzyxx"}, "bad_message", "axes"),
    ({"axes": 4}, "bad_message", "axes"),
    ({"variable": 4}, "bad_message", "variable"),
    ({"box": [[0, 1], [0, 1], [0, 1], [1, 1]]}, "out_of_range", "no extent along w"),
    ({"box": [[1, 0], [0, 1], [0, 1], [0, 1]]}, "out_of_range", "along x are in the wrong order"),
    ({"box": [[0, 1e31], [0, 1], [0, 1], [0, 1]]}, "bad_field", "1e30"),
    ({"box": [[0, 1]] * 3}, "bad_message", "box"),
    ({"append": 1}, "bad_message", "append"),
])
async def test_wrong_members_of_arrays_are_refused(server, members, code, text):
    async with Client(server) as client:
        before = unnumbered(await state_of(client))
        with pytest.raises(Refused) as refused:
            await load(client, "a", npy(quadratic()), **members)
        assert refused.value.code == code and text in refused.value.text
        assert unnumbered(await state_of(client)) == before


@pytest.mark.parametrize("members", [{"axes": "x"}, {"variable": "v"}, {"append": True}])
@pytest.mark.parametrize("format_, data", [("points", "0 0 0 0"), ("formula", "x")])
async def test_only_arrays_take_these_members(server, format_, data, members):
    async with Client(server) as client:
        with pytest.raises(Refused, match="only arrays|no field called") as refused:
            await client.request("load", name="a", format=format_, data=data, **members)
        assert refused.value.code in ("bad_message", "not_found")
