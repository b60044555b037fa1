# What server/run and tests/run have in common: installing, compiling, and saying so in few words.
# Sourced by bash; the caller has set `root` to the top of the project.

logs=$root/build/log
mkdir -p "$logs"

# So that a fresh clone elsewhere finds what was compiled before.
export CCACHE_BASEDIR=$root CCACHE_NOHASHDIR=1
[[ -w ${HOME-} ]] || export HOME=$root/build/home # for the caches of ccache and npm

say() { printf 'oval4d: %s\n' "$*" >&2; }

die() {
    say "$@"
    exit 1
}

# On a terminal, shows the last line of a log while it grows.
show_progress() {
    while sleep 0.5 && kill -0 $$ 2>/dev/null; do
        printf '\r\e[K  %s' "$(tail -c 400 "$1" | tail -n 1 | cut -c "1-$(($(tput cols) - 4))")" >&2
    done
}

# step <log> <what> <command …>: runs the command, its output in build/log/<log>.log; a failure shows the end of it.
# With `unattended` set, progress is not shown.
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
        say "FAILED: $what. All of the output is in ${log#"$root"/}"
    fi
    return $status
}

# --- Debian and Ubuntu packages

node_suits() { command -v npm >/dev/null && node -e 'process.exit(parseInt(process.versions.node) < 18 ? 1 : 0)' 2>/dev/null; }
apt_knows() { [[ $(LC_ALL=C apt-cache policy "$1" 2>/dev/null) == *"Candidate: "[0-9]* ]]; }

# Prints the packages of the lists that are missing. Of alternatives, the first that is installed or known to apt counts.
missing_packages() {
    local line name missing
    local -A installed=()
    while read -r name; do installed[$name]=1; done < <(dpkg-query -W -f '${Package} ${db:Status-Status}\n' | sed -n 's/ installed$//p')
    sed -e 's/#.*//' -e 's/[[:space:]]//g' -e '/^$/d' "$@" | while read -r line; do
        [[ $line =~ ^(nodejs|npm)$ ]] && node_suits && continue
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

# Installs what is missing of the lists.
install_packages() {
    local missing
    if ! command -v dpkg-query >/dev/null; then
        say "this is not Debian or Ubuntu: the packages in ${*#"$root"/} are taken to be there"
        return
    fi
    missing=$(missing_packages "$@")
    [[ $missing ]] || return 0
    ((EUID == 0)) || command -v sudo >/dev/null || die "there is no sudo; as root, install these packages first:" $missing
    step apt-update "fetching the lists of packages" apt_get update || return
    missing=$(missing_packages "$@")
    step apt-install "installing $(wc -w <<<"$missing") packages" \
        apt_get install --yes --no-install-recommends --no-remove $missing
}

# --- npm packages and the web client

hash_of() { find "$@" \( -name node_modules -o -name dist \) -prune -o -type f -print0 | sort -z | xargs -0 sha256sum | sha256sum; }

# unchanged <stamp> <sources …>: whether the sources are as they were at the last `remember`.
unchanged() { [[ -e $1 && $(<"$1") == "$(hash_of "${@:2}")" ]]; }
remember() { hash_of "${@:2}" >"$1"; }

# Installs the npm packages that the folder's package-lock.json names.
install_npm() {
    local lock=$root/$1/package-lock.json stamp=$root/$1/node_modules/.installed
    unchanged "$stamp" "$lock" && return
    step "npm-${1//\//-}" "installing the npm packages of $1" npm --prefix "$root/$1" ci --no-audit --no-fund || return
    remember "$stamp" "$lock"
}

build_web_client() {
    local stamp=$root/web_client/dist/.built sources=("$root/web_client" "$root/protocol")
    unchanged "$stamp" "${sources[@]}" && return
    install_npm web_client || return
    step web_client "building the web client" npm --prefix "$root/web_client" run build || return
    remember "$stamp" "${sources[@]}"
}

# --- C++

# As many compilers as processors, but each with 1 GB of memory.
jobs() {
    awk -v processors="$(nproc)" '/MemAvailable/ { n = int($2 / 1048576); print n < 1 ? 1 : n < processors ? n : processors }' /proc/meminfo
}

# configure <preset> <options of CMake …>
configure() {
    step "configure-$1" "configuring build/$1" env -C "$root" cmake --preset "$@"
}

# compile <preset> <targets …>
compile() {
    step "compile-$1" "compiling build/$1" cmake --build "$root/build/$1" --parallel "$(jobs)" --target "${@:2}"
}
