"""Pictures beside the making of files, and the opening of large arrays, each compared with a control in the same run."""

import asyncio
import statistics
import time

from harness import Server
from test_export_requests import LONG_FILE, requested_files
from test_large_fields import open_server, sparse_npy
from wire import Client

SIZE = {"width": 320, "height": 180}
SAMPLES = 100


async def seconds_to_slices(client):
    start = time.perf_counter()
    done = await client.request("key", key="r")
    await client.wait_for_slices(done["revision"])
    return time.perf_counter() - start


async def test_pictures_are_hardly_slower_beside_files():
    """A server with one worker for files makes some; the control makes none, and shares the processors with it."""
    options = ("--max-file-triangles", 20_000_000, "--stop-timeout", 0.2)
    with Server(*options) as busy, Server(*options) as control:
        geometry = {"stream": "geometry", "compares": False}
        async with Client(busy, **geometry) as here, Client(control, **geometry) as there:
            for client in (here, there):
                await client.wait_for_slices(0)
            beside, alone = [], []
            async with requested_files(busy, 5) as files:
                for _ in range(SAMPLES):
                    beside.append(await seconds_to_slices(here))
                    alone.append(await seconds_to_slices(there))
                assert not all(file.done() for file in files), LONG_FILE
                assert (await asyncio.to_thread(busy.stop))[0] == 0
    ratio = statistics.median(beside) / statistics.median(alone)
    print(f"pictures beside files take {ratio:.2f} times as long: {1e3 * statistics.median(beside):.2f} ms")
    assert ratio < 4


async def test_a_large_array_opens_almost_as_fast_as_a_small_one(tmp_path):
    """The first picture of an array, a draft, does not require that the server reads all of it."""
    folder = tmp_path / "data"
    folder.mkdir()
    sizes = {"small": 64, "large": 512}  # side lengths of 100 moments: 0.1 GB and 54 GB
    for name, size in sizes.items():
        sparse_npy(folder / f"{name}.npy", (100, size, size, size), [])
    seconds = {name: [] for name in sizes}
    with open_server(folder, "--max-field-bytes", "1M") as server:
        for _ in range(5):
            for name in sizes:
                async with Client(server, stream="geometry", compares=False, **SIZE) as client:
                    await client.wait_for_slices(0)
                    start = time.perf_counter()
                    done = await client.request("load", name="run", path=f"{name}.npy")
                    first = lambda: any(m["revision"] == done["revision"] for m in client.streamed_messages("slices"))
                    await client.wait_until(first)
                    seconds[name].append(time.perf_counter() - start)
    medians = {name: statistics.median(values) for name, values in seconds.items()}
    print("seconds to open: " + ", ".join(f"{name} {value:.3f}" for name, value in medians.items()))
    assert medians["large"] < 50 * medians["small"]  # the large array has 512 times as many samples
