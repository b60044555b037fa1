"""Builds the image from docker/Dockerfile without a Docker engine: with buildah, on a base image made by debootstrap.

The base image and unchanged layers are kept in build/container between runs, and ccache keeps compiled sources.
"""

import json
import os
import resource
import shutil
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
KEPT = ROOT / "build/container"
IMAGE, BASE = "localhost/oval4d", "localhost/oval4d-base"


def debian_release():
    """Returns the code name of this machine's Debian release. The image uses the same one, because frames are equal
    only if they are drawn with the same libraries."""
    lines = Path("/etc/os-release").read_text(encoding="utf-8").splitlines()
    return dict(line.split("=", 1) for line in lines if "=" in line)["VERSION_CODENAME"].strip('"')


def reason_to_skip():
    """Returns why this machine cannot build the image, None if it can."""
    if os.geteuid() != 0:
        return "only root can create the base image with debootstrap"
    absent = [tool for tool in ("buildah", "debootstrap") if shutil.which(tool) is None]
    return f"{' and '.join(absent)} cannot be installed" if absent else None


def run(*arguments, **keywords):
    done = subprocess.run([*map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False,
                          **keywords)
    assert done.returncode == 0, f"{' '.join(map(str, arguments))}\n{done.stdout[-6000:]}"
    return done.stdout.strip()


class ImageBuilder:
    """Runs buildah with its own storage: overlay, or vfs, which copies files, where overlay does not work."""

    def __init__(self):
        faults = []
        for driver in ("overlay", "vfs"):
            self.driver = driver
            try:
                container = self.buildah("from", "scratch")
                self.buildah("mount", container)
                self.buildah("umount", container)
                self.buildah("rm", container)
                return
            except AssertionError as fault:
                faults.append(str(fault))
                shutil.rmtree(KEPT / driver, ignore_errors=True)
        raise AssertionError("no storage driver of buildah works here: " + "; ".join(faults))

    def buildah(self, *arguments):
        KEPT.mkdir(parents=True, exist_ok=True)
        storage = ["--root", KEPT / self.driver, "--runroot", KEPT / f"{self.driver}-run"]
        variables = {**os.environ, "STORAGE_DRIVER": self.driver, "BUILDAH_ISOLATION": "chroot"}
        return run("buildah", *storage, *arguments, env=variables, cwd=ROOT)

    def has_image(self, image):
        try:
            return bool(self.buildah("images", "--quiet", image))
        except AssertionError:
            return False

    def base_image(self):
        """Returns the name of the base image, a minimal Debian with this machine's package sources; may create it."""
        name = f"{BASE}:{debian_release()}"
        if self.has_image(name):
            return name
        files = KEPT / "rootfs"
        shutil.rmtree(files, ignore_errors=True)
        run("debootstrap", "--variant=minbase", debian_release(), files)
        for file in Path("/etc/apt/apt.conf.d").glob("99*"):
            shutil.copy(file, files / "etc/apt/apt.conf.d")
        authorities = list(Path("/usr/local/share/ca-certificates").glob("*.crt"))
        if "NODE_EXTRA_CA_CERTS" in os.environ:
            authorities.append(Path(os.environ["NODE_EXTRA_CA_CERTS"]))
        if authorities:  # this machine downloads packages through a proxy with its own certificate authority
            (files / "usr/local/share/ca-certificates").mkdir(parents=True, exist_ok=True)
            for file in authorities:
                shutil.copy(file, files / "usr/local/share/ca-certificates")
            (files / "root/.npmrc").write_text("cafile=/etc/ssl/certs/ca-certificates.crt\n", encoding="ascii")
        container = self.buildah("from", "scratch")
        place = self.buildah("mount", container)
        run("cp", "-a", f"{files}/.", place)
        self.buildah("umount", container)
        self.buildah("commit", "--quiet", container, name)
        self.buildah("rm", container)
        shutil.rmtree(files)
        return name

    def build(self):
        """Builds the image; only its base depends on this machine."""
        try:
            self.build_once()
        except AssertionError as fault:
            if "read-write layer" not in str(fault) and "layer not known" not in str(fault):
                raise
            # The kept layers are damaged, for example because an earlier run was killed.
            shutil.rmtree(KEPT / self.driver)
            self.build_once()

    def build_once(self):
        cache = Path(run("ccache", "--get-config", "cache_dir"))
        cache.mkdir(parents=True, exist_ok=True)
        # buildah's default limits may be higher than this machine allows, or lower than the build needs.
        limits = [f"--ulimit={name}={min(most, resource.getrlimit(kind)[1])}" for name, kind, most in
                  (("nofile", resource.RLIMIT_NOFILE, 20_000), ("nproc", resource.RLIMIT_NPROC, 32_768))]
        self.buildah("build", *limits, "--layers", "--format", "docker", "--isolation", "chroot", "--pull-never",
                     "--build-arg", f"BASE={self.base_image()}", "--ignorefile", "docker/Dockerfile.dockerignore",
                     "--volume", f"{cache}:/root/.cache/ccache:rw", "--file", "docker/Dockerfile", "--tag", IMAGE, ".")


class BuiltImage:
    """The built image, with its files mounted."""

    def __init__(self, builder):
        self.builder = builder

    def __enter__(self):
        self.builder.build()
        self.container = self.builder.buildah("from", "--pull-never", IMAGE)
        self.files = Path(self.builder.buildah("mount", self.container))
        self.description = json.loads(self.builder.buildah("inspect", "--type", "image", IMAGE))
        self.config = self.description["OCIv1"]["config"]
        self.variables = dict(pair.split("=", 1) for pair in self.config["Env"])
        return self

    def __exit__(self, *_):
        self.builder.buildah("umount", self.container)
        self.builder.buildah("rm", self.container)
