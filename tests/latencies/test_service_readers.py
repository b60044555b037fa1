"""The clients refuse damaged messages about as fast as they read the largest undamaged ones."""

import random
import time

from oval4d_client import from_cbor, png_state
from test_readers import damaged_copy, message_folder, read_damaged, write_messages  # noqa: F401


async def test_the_python_client_reads_damaged_messages_fast(server, message_folder):  # noqa: F811
    await write_messages(server, message_folder)
    rng = random.Random(11)
    for read, kind in ((from_cbor, "cbor"), (png_state, "png")):
        undamaged, damaged = [], []
        for _ in range(20):
            for file in sorted(message_folder.glob(f"*.{kind}")):
                whole = file.read_bytes()
                for times, data in ((undamaged, whole), *((damaged, damaged_copy(whole, rng)) for _ in range(30))):
                    start = time.thread_time()
                    try:
                        read(data)
                    except ValueError:
                        pass
                    times.append(time.thread_time() - start)
        print(f"{kind}: the slowest damaged message took {max(damaged) / max(undamaged):.2f} times as long as the slowest other")
        assert max(damaged) < 20 * max(undamaged)


async def test_the_typescript_client_reads_damaged_messages_fast(server, message_folder):  # noqa: F811
    await write_messages(server, message_folder)
    for kind, count in read_damaged(message_folder).items():
        print(f"{kind}: {count}")
        assert count["slowest"] < 20 * count["slowestUndamaged"]
