# Shared by demo.sh and test.sh (sourced): installs what is missing from Debian and builds a preset.

roevo_packages="build-essential cmake ninja-build ccache git pkg-config libmrpt-dev mrpt-common mrpt-apps libopencv-dev
    libceres-dev libeigen3-dev libgtest-dev libbenchmark-dev libcli11-dev nlohmann-json3-dev zlib1g-dev libjpeg-dev
    libsqlite3-dev libyaml-cpp-dev liblz4-dev libzstd-dev libbz2-dev
    librosbag-storage-dev libsensor-msgs-dev libtf2-msgs-dev gnuplot-nox libjs-three
    python3-dev pybind11-dev python3-numpy python3-pil"
roevo_batch_packages=snakemake # 680 MB, for roevo-batch alone

say() { printf '\n== %s\n' "$*"; }

die() {
    printf '%s: error: %s\n' "$(basename "$0")" "$*" >&2
    exit 1
}

# install_packages [MORE...]: installs those of $roevo_packages, and of what else is named, that are missing; does not
# touch apt when nothing is.
install_packages() {
    command -v dpkg-query >/dev/null || die "this set-up is for Debian 12 and 13; install by hand: $(echo $roevo_packages "$@")"
    missing=
    for package in $roevo_packages "$@"; do
        case "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" in
        installed) ;;
        *) missing="$missing $package" ;;
        esac
    done
    [ -z "$missing" ] && return 0

    say "Installing$missing"
    as_root=
    if [ "$(id -u)" -ne 0 ]; then
        command -v sudo >/dev/null || die "packages are missing and there is no sudo; as root: apt-get install$missing"
        as_root=sudo
    fi
    apt="$as_root env DEBIAN_FRONTEND=noninteractive apt-get -qq -o Dpkg::Use-Pty=0"
    $apt update || die "apt-get update failed; is the network reachable?"
    $apt install -y --no-install-recommends $missing || die "apt-get install failed for:$missing"
}

# build PRESET [TARGETS...]: configures when there is no build yet, or when the last configuration did not finish, and
# builds the targets, or everything.
build() {
    preset=$1
    shift
    say "Building ${*:-everything} (preset $preset)"
    [ -f "build/$preset/build.ninja" ] || cmake --preset "$preset" >"build-$preset.log" 2>&1 || {
        cat "build-$preset.log"
        die "cmake could not configure preset $preset"
    }
    rm -f "build-$preset.log"
    cmake --build --preset "$preset" -j "$(nproc)" ${1:+--target "$@"} || die "the build of preset $preset failed"
}
