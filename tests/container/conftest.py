"""Fixtures of the container tests; the image is built once for all of them."""

import warnings

import image
import pytest


@pytest.fixture(scope="session", name="built_image")
def build_image():
    reason = image.reason_to_skip()
    if reason:
        warnings.warn(f"THE CONTAINER IS NOT TESTED: {reason}")
        pytest.skip(reason)
    with image.BuiltImage(image.ImageBuilder()) as built_image:
        yield built_image
