"""Builds the image from docker/Dockerfile as it stands, without a Docker engine: by buildah, on a base made by debootstrap.

What can be kept between runs is kept in build/container: the base, and the layers of the image up to what has changed.
What was compiled before, ccache knows.
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


def release():
    """The distribution's name of this machine's release: the same libraries draw the same frames."""
    lines = Path("/etc/os-release").read_text(encoding="utf-8").splitlines()
    return dict(line.split("=", 1) for line in lines if "=" in line)["VERSION_CODENAME"].strip('"')


def missing():
    """Why no image can be built here, or nothing."""
    if os.geteuid() != 0:
        return "only root can make a base by debootstrap"
    absent = [tool for tool in ("buildah", "debootstrap") if shutil.which(tool) is None]
    return f"{' and '.join(absent)} cannot be installed" if absent else None


def run(*words, **keywords):
    done = subprocess.run([*map(str, words)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False,
                          **keywords)
    assert done.returncode == 0, f"{' '.join(map(str, words))}\n{done.stdout[-6000:]}"
    return done.stdout.strip()


class Builder:
    """buildah with a store of its own. Where the system's overlay does not work inside a sandbox, files are copied."""

    def __init__(self):
        faults = []
        for driver in ("overlay", "vfs"):
            self.driver = driver
            try:
                container = self("from", "scratch")
                self("mount", container)
                self("umount", container)
                self("rm", container)
                return
            except AssertionError as fault:
                faults.append(str(fault))
                shutil.rmtree(KEPT / driver, ignore_errors=True)
        raise AssertionError("buildah has no storage that works here: " + "; ".join(faults))

    def __call__(self, *words):
        KEPT.mkdir(parents=True, exist_ok=True)
        places = ["--root", KEPT / self.driver, "--runroot", KEPT / f"{self.driver}-run"]
        return run("buildah", *places, *words, env={**os.environ, "STORAGE_DRIVER": self.driver, "BUILDAH_ISOLATION": "chroot"},
                   cwd=ROOT)

    def has(self, image):
        try:
            return bool(self("images", "--quiet", image))
        except AssertionError:
            return False

    def base(self):
        """A minimal Debian, with this machine's way to the packages."""
        name = f"{BASE}:{release()}"
        if self.has(name):
            return name
        files = KEPT / "rootfs"
        shutil.rmtree(files, ignore_errors=True)
        run("debootstrap", "--variant=minbase", release(), files)
        for file in Path("/etc/apt/apt.conf.d").glob("99*"):
            shutil.copy(file, files / "etc/apt/apt.conf.d")
        authorities = list(Path("/usr/local/share/ca-certificates").glob("*.crt"))
        if "NODE_EXTRA_CA_CERTS" in os.environ:
            authorities.append(Path(os.environ["NODE_EXTRA_CA_CERTS"]))
        if authorities:  # the packages come by a proxy of this machine's own
            (files / "usr/local/share/ca-certificates").mkdir(parents=True, exist_ok=True)
            for file in authorities:
                shutil.copy(file, files / "usr/local/share/ca-certificates")
            (files / "root/.npmrc").write_text("cafile=/etc/ssl/certs/ca-certificates.crt\n", encoding="ascii")
        container = self("from", "scratch")
        place = self("mount", container)
        run("cp", "-a", f"{files}/.", place)
        self("umount", container)
        self("commit", "--quiet", container, name)
        self("rm", container)
        shutil.rmtree(files)
        return name

    def build(self):
        """The image. Nothing of it but the base is special to this machine."""
        try:
            self.build_here()
        except AssertionError as fault:
            if "read-write layer" not in str(fault) and "layer not known" not in str(fault):
                raise
            # What was kept is damaged: a run before may have been killed.
            shutil.rmtree(KEPT / self.driver)
            self.build_here()

    def build_here(self):
        cache = Path(run("ccache", "--get-config", "cache_dir"))
        cache.mkdir(parents=True, exist_ok=True)
        # Its own limits would be higher than what may be allowed here, or lower than what may be asked for.
        limits = [f"--ulimit={name}={min(most, resource.getrlimit(kind)[1])}" for name, kind, most in
                  (("nofile", resource.RLIMIT_NOFILE, 20_000), ("nproc", resource.RLIMIT_NPROC, 32_768))]
        self("build", *limits, "--layers", "--format", "docker", "--isolation", "chroot", "--pull-never", "--build-arg", f"BASE={self.base()}",
             "--ignorefile", "docker/Dockerfile.dockerignore", "--volume", f"{cache}:/root/.cache/ccache:rw",
             "--file", "docker/Dockerfile", "--tag", IMAGE, ".")


class Built:
    """The image and its files."""

    def __init__(self, builder):
        self.builder = builder

    def __enter__(self):
        self.builder.build()
        self.container = self.builder("from", "--pull-never", IMAGE)
        self.files = Path(self.builder("mount", self.container))
        self.said = json.loads(self.builder("inspect", "--type", "image", IMAGE))
        self.config = self.said["OCIv1"]["config"]
        self.variables = dict(pair.split("=", 1) for pair in self.config["Env"])
        return self

    def __exit__(self, *_):
        self.builder("umount", self.container)
        self.builder("rm", self.container)
