"""Fixtures of the container tests; the image is built once for all of them."""

import warnings

import image
import pytest


@pytest.fixture(scope="session", name="built")
def built_image():
    why = image.missing()
    if why:
        warnings.warn(f"THE CONTAINER IS NOT TESTED: {why}")
        pytest.skip(why)
    with image.Built(image.Builder()) as built:
        yield built
