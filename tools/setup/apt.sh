# shellcheck shell=bash
# Sourced after lib.sh: packages of Debian (or a relative) unpacked into a private folder. No root, and the
# system's own package state is read, never written: configuration, lists and archives are private.

# the machine's own package sources as "uri suite component signed-by" lines
apt_sources() {
    apt-get indextargets --format '$(REPO_URI) $(RELEASE) $(COMPONENT) $(SIGNED_BY)' 'Created-By: Packages' 2>/dev/null | sort -u
}

# the address of the machine's own Debian mirror: the source that carries its release, not updates or security
apt_debian_mirror() {
    local codename
    codename=$(. /etc/os-release && printf '%s' "${ID:-}:${VERSION_CODENAME:-}")
    [[ $codename == debian:* ]] || return 1
    apt_sources | awk -v suite="${codename#debian:}" '
        $3 == "main" && ($2 == suite || $2 ~ /^(stable|testing|unstable|sid|forky)$/) { print $1; exit }'
}

# apt_require WHAT HOW: says what is missing and how to provide it on a system where packages cannot be fetched
apt_require() {
    command -v apt-get >/dev/null && command -v dpkg-deb >/dev/null && return 0
    die "$1 is missing and this system has no apt to fetch it with ($(uname -s)). $2"
}

# apt_unpack PARTIAL SUITE PACKAGES...: downloads packages with all that they need and unpacks them into PARTIAL.
# SUITE "own": the machine's release, leaving out what the system has; else that suite of its mirror, complete.
apt_unpack() {
    local partial=$1 suite=$2
    shift 2
    local apt=$partial/.apt mirror
    mkdir -p "$apt/lists/partial" "$apt/archives/partial"
    if [[ $suite == own ]]; then
        apt_sources | awk '{ signed = $4 ~ /^\// ? " signed-by=" $4 : ""
            print "deb [target=Packages" signed "] " $1 " " $2 " " $3 }' >"$apt/sources.list"
        [[ -s $apt/sources.list ]] || die "apt on this machine names no package source; add one to /etc/apt/sources.list.d"
        # a copy: apt locks the folder of the one it reads
        cp /var/lib/dpkg/status "$apt/status"
    else
        mirror=$(apt_debian_mirror) && [[ -n $mirror ]] || return 1
        local keys=/usr/share/keyrings/debian-archive-keyring.gpg signed=
        [[ ! -f $keys ]] || signed=" signed-by=$keys"
        printf 'deb [target=Packages%s] %s %s main\n' "$signed" "$mirror" "$suite" >"$apt/sources.list"
        : >"$apt/status"
    fi
    mkdir "$apt/none"
    # read last, so it wins over the machine's own files; hooks of the machine would write outside
    cat >"$apt/apt.conf" <<EOF
#clear APT::Update;
#clear DPkg;
Dir::Etc::sourcelist "$apt/sources.list";
Dir::Etc::sourceparts "$apt/none";
Dir::Etc::preferences "$apt/no-preferences";
Dir::Etc::preferencesparts "$apt/none";
Dir::State "$apt";
Dir::State::lists "$apt/lists";
Dir::State::status "$apt/status";
Dir::Cache "$apt";
Dir::Cache::archives "$apt/archives";
Dir::Log "$apt";
APT::Sandbox::User "$(id -un)";
APT::Install-Recommends "false";
APT::Get::Assume-Yes "true";
Acquire::PDiffs "false";
Acquire::Retries "3";
Acquire::Languages "none";
EOF
    say "reading the package lists of ${suite/own/this release}"
    apt-get -c "$apt/apt.conf" -qq update >&2 || return 1
    say "fetching $*"
    # plain progress lines only where someone watches
    local quiet=-qq
    [[ ! -t 2 ]] || quiet=-q=0
    apt-get -c "$apt/apt.conf" "$quiet" --download-only install "$@" >&2 || return 1
    local deb count
    count=$(find "$apt/archives" -maxdepth 1 -name '*.deb' | wc -l)
    say "unpacking $count packages"
    for deb in "$apt"/archives/*.deb; do
        [[ -e $deb ]] || continue
        dpkg-deb -x "$deb" "$partial" || return 1
        basename "$deb" .deb >>"$partial/packages.txt"
    done
    rm -rf "$apt"
}
