# shellcheck shell=bash
# Functions that server/build, tests/run and other scripts share: they install packages, configure and compile, and show
# the progress in one line. Bash scripts source this file, with `root` set to the top folder of the project.

logs=${root:?must be the top of the project}/build/log
mkdir -p "$logs"

[[ -w ${HOME-} ]] || export HOME=$root/build/home # ccache and npm need a writable home

say() { printf 'oval4d: %s\n' "$*" >&2; }

die() {
    say "$@"
    exit 1
}

# show_progress <log>: keeps showing the last line of a growing log on the terminal. Ends when it is killed or when the
# script ends.
show_progress() {
    while sleep 0.5 && kill -0 $$ 2>/dev/null; do
        printf '\r\e[K  %s' "$(tail -c 400 "$1" | tail -n 1 | cut -c "1-$(($(tput cols) - 4))")" >&2
    done
}

# step <log> <what> <command …>: prints <what>, runs the command, and writes the command's output to
# build/log/<log>.log. Shows progress on a terminal, unless `unattended` is set. Returns the command's status; if the
# command fails, first prints the end of the log.
step() {
    local log=$logs/$1.log what=$2 status=0 progress=
    shift 2
    say "$what …"
    : >"$log"
    if [[ -t 2 && ! ${unattended-} ]]; then
        show_progress "$log" &
        progress=$!
    fi
    "$@" >"$log" 2>&1 </dev/null || status=$?
    if [[ $progress ]]; then
        kill "$progress"
        printf '\r\e[K' >&2
    fi
    if ((status)); then
        tail -n 25 "$log" >&2
        say "FAILED: $what. The full output is in ${log#"$root"/}"
    fi
    return $status
}

# --- Debian and Ubuntu packages

# Succeeds if npm and Node.js 18 or newer are installed, even if not from a Debian package.
has_recent_node() {
    command -v npm >/dev/null && node -e 'process.exit(parseInt(process.versions.node) < 18 ? 1 : 0)' 2>/dev/null
}
# apt_knows <package>: succeeds if apt can install the package.
apt_knows() { [[ $(LC_ALL=C apt-cache policy "$1" 2>/dev/null) == *"Candidate: "[0-9]* ]]; }

# missing_packages <lists …>: prints the packages in these list files that are not installed, one per line. A line may
# list alternatives (a|b): the first one that is installed or that apt can install is chosen, else the last one.
missing_packages() {
    local line name missing
    local -A installed=()
    while read -r name; do installed[$name]=1; done \
        < <(dpkg-query -W -f '${Package} ${db:Status-Status}\n' | sed -n 's/ installed$//p')
    sed -e 's/#.*//' -e 's/[[:space:]]//g' -e '/^$/d' "$@" | while read -r line; do
        [[ $line =~ ^(nodejs|npm)$ ]] && has_recent_node && continue
        for name in ${line//|/ }; do
            [[ ${installed[$name]-} ]] && continue 2
            missing=$name
            [[ $line != *'|'* ]] || apt_knows "$name" && break
        done
        echo "$missing"
    done
}

apt_get() {
    local as_root=()
    ((EUID == 0)) || as_root=(sudo)
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=300 "$@"
}

# install_packages <lists …>: installs the missing packages of these list files.
install_packages() {
    local missing packages
    if ! command -v dpkg-query >/dev/null; then
        say "this is not Debian or Ubuntu: assuming that the packages in ${*#"$root"/} are installed"
        return
    fi
    missing=$(missing_packages "$@")
    [[ $missing ]] || return 0
    ((EUID == 0)) || command -v sudo >/dev/null ||
        die "sudo is not installed; install these packages as root first: ${missing//$'\n'/ }"
    step apt-update "updating the package lists" apt_get update || return
    missing=$(missing_packages "$@") # the choice among alternatives may have changed
    mapfile -t packages <<<"$missing"
    step apt-install "installing ${#packages[@]} packages" \
        apt_get install --yes --no-install-recommends --no-remove "${packages[@]}"
}

# --- npm packages and the web client

# hash_of <files and folders …>: prints a digest of their paths and contents, without node_modules and dist folders.
hash_of() {
    find "$@" \( -name node_modules -o -name dist \) -prune -o -type f -print0 | sort -z | xargs -0 sha256sum | sha256sum
}

# remember <stamp> <sources …>: writes the digest of the sources to the stamp file.
# unchanged <stamp> <sources …>: succeeds if the sources are unchanged since `remember` last wrote the stamp file.
unchanged() { [[ -e $1 && $(<"$1") == "$(hash_of "${@:2}")" ]]; }
remember() { hash_of "${@:2}" >"$1"; }

# install_npm <folder>: installs the npm packages of the folder's package-lock.json, unless they are up to date.
install_npm() {
    local lock=$root/$1/package-lock.json stamp=$root/$1/node_modules/.installed
    unchanged "$stamp" "$lock" && return
    step "npm-${1//\//-}" "installing the npm packages of $1" npm --prefix "$root/$1" ci --no-audit --no-fund || return
    remember "$stamp" "$lock"
}

# Builds web_client/dist, unless it is up to date.
build_web_client() {
    local stamp=$root/web_client/dist/.built sources=("$root/web_client" "$root/protocol")
    unchanged "$stamp" "${sources[@]}" && return
    install_npm web_client || return
    step web_client "building the web client" npm --prefix "$root/web_client" run build || return
    remember "$stamp" "${sources[@]}"
}

# --- C++

# Prints the number of compiler processes to run at once: one per processor, but at most one per GiB of available
# memory, and at least one.
compile_jobs() {
    awk -v processors="$(nproc)" \
        '/MemAvailable/ { n = int($2 / 1048576); print n < 1 ? 1 : n < processors ? n : processors }' /proc/meminfo
}

# configure <preset> <CMake options …>: runs CMake with a preset of CMakePresets.json.
configure() {
    step "configure-$1" "configuring build/$1" env -C "$root" cmake --preset "$@"
}

# compile <preset> <targets …>: builds the targets in build/<preset>.
compile() {
    step "compile-$1" "compiling build/$1" cmake --build "$root/build/$1" --parallel "$(compile_jobs)" --target "${@:2}"
}

# build_sanitized <asan-ubsan|tsan> <targets …>: builds the targets with sanitizers. With asan-ubsan, uses Clang, which
# the fuzzers need, in a version whose runtime libraries tests/packages/fuzz.txt names.
build_sanitized() {
    local compiler=() clang
    if [[ $1 == asan-ubsan ]]; then
        for clang in clang++-16 clang++-19 clang++; do command -v "$clang" >/dev/null && break; done
        compiler=("-DCMAKE_CXX_COMPILER=$clang")
    fi
    configure "$1" "${compiler[@]}" && compile "$@"
}
