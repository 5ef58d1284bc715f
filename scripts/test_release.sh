#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
#
# Runs the scripts of the current commit in a minimal Debian root of another release. Needs to be run
# as root; needs debootstrap and git.
#
#   scripts/test_release.sh [OPTION ...] RELEASE [COMMAND [ARGUMENT ...]]
#
#   RELEASE    bookworm (Debian 12) or trixie (Debian 13)
#   COMMAND    demo, test, package, docs, lab, wheel   scripts/COMMAND.sh
#              ci                                      .ci/run
#              compile                                 configure and compile the command line
#              run                                     the program named by the next argument
#              Without a command, only the root is made.
#   ARGUMENT   passed to the command
#
#   --fresh    remove the root first, then make a new one without any further package
#   --keep     update the clone of the last run, with its builds, instead of cloning again
#   --ccache   use a compiler cache, which is kept in the root; otherwise none is used
#   --remove   remove the root, and do nothing else
#
# The root is ~/.cache/tofsmith-roots/RELEASE, or RELEASE in the directory TOFSMITH_ROOTS. It is made
# by debootstrap from TOFSMITH_DEBIAN_MIRROR if it does not exist. The commit is cloned into it and
# the command runs in the clone. The exit status is that of the command.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=scripts/packages.sh
source "$root/scripts/packages.sh"

fresh='' keep='' ccache='' remove=''
while (($#)); do
  case "$1" in
    -h | --help)
      print_help && exit
      ;;
    --fresh) fresh=yes ;;
    --keep) keep=yes ;;
    --ccache) ccache=yes ;;
    --remove) remove=yes ;;
    -*) tofsmith_die "unknown option $1; see --help" ;;
    *) break ;;
  esac
  shift
done
(($#)) || tofsmith_die "no release is given; expected bookworm or trixie; see --help"
release=$1 && shift
[[ " $tofsmith_releases " == *" $release "* ]] ||
  tofsmith_die "found release '$release'; expected one of: $tofsmith_releases"
command=()
if (($#)); then
  case "$1" in
    demo | test | package | docs | lab | wheel) command=("scripts/$1.sh") ;;
    ci) command=(.ci/run) ;;
    compile)
      command=(bash -c 'scripts/packages.sh build && cmake --preset quick && cmake --build --preset quick')
      ;;
    run) (($# > 1)) || tofsmith_die "run: no program is given" ;;
    *) tofsmith_die "found command '$1'; expected demo, test, package, docs, lab, wheel, ci, compile or run" ;;
  esac
  name=$1
  command+=("${@:2}")
fi

((EUID == 0)) || tofsmith_die "needs to be run as root: it makes a Debian root and enters it by chroot"
place=$(release_root "$release")
mkdir -p "$(dirname "$place")"
exec 9>"$place.lock"
flock --nonblock 9 || tofsmith_die "another run uses $place"

# Mounts exist only in separate mount namespaces (see enter), so none can remain in this one.
remove_root() { rm -rf --one-file-system "$place" "$place.part"; }
[[ -z "$fresh$remove" ]] || remove_root
[[ -z "$remove" ]] || exit 0

if [[ ! -d "$place" ]]; then
  command -v debootstrap >/dev/null || tofsmith_die "debootstrap is missing: apt-get install debootstrap"
  echo "Making a $release root in $place"
  rm -rf --one-file-system "$place.part"
  log="$place.log"
  debootstrap --variant=minbase --include=git "$release" "$place.part" \
    "${TOFSMITH_DEBIAN_MIRROR:-http://deb.debian.org/debian}" >"$log" 2>&1 ||
    tofsmith_die "debootstrap failed; its messages are in $log"
  mv "$place.part" "$place"
fi
# As written by Debian's installer: browsers and their drivers communicate by this name.
[[ -e "$place/etc/hosts" ]] || printf '127.0.0.1\tlocalhost\n::1\tlocalhost\n' >"$place/etc/hosts"
# Network settings for reaching the mirror.
cp /etc/resolv.conf "$place/etc/resolv.conf"
apt-config dump 2>/dev/null | grep -E '^Acquire::(https?::|Check-|Retries|ForceIPv)' \
  >"$place/etc/apt/apt.conf.d/90host" || true

# Runs a command in the root. Its mounts and processes end with it.
enter() {
  # shellcheck disable=SC2016  # $place belongs to the inner shell
  place="$place" unshare --mount --propagation private --pid --fork --kill-child \
    bash -c 'set -e
      mount -t proc proc "$place/proc"
      mount --rbind /dev "$place/dev"
      mount --rbind /sys "$place/sys"
      exec chroot "$place" "$@"' enter \
    env -i "${environment[@]}" sh -c 'cd /root && exec "$@"' sh "$@" 9>&-
}
environment=(HOME=/root PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin
  LANG=C.UTF-8 TERM="${TERM:-dumb}")
for variable in CI CMAKE_BUILD_PARALLEL_LEVEL OPENBLAS_CORETYPE OPENBLAS_L2_SIZE; do
  [[ -z "${!variable:-}" ]] || environment+=("$variable=${!variable}")
done
if [[ -z "$ccache" ]]; then
  environment+=(CCACHE_DISABLE=1)
elif [[ ! -x "$place/usr/bin/ccache" ]]; then
  enter sh -c 'apt-get -q update && apt-get -q -y install --no-install-recommends ccache' >/dev/null
fi
((${#command[@]})) || { echo "The root is $place" && exit 0; }

commit=$(git -C "$root" rev-parse HEAD) || tofsmith_die "$root is no clone: git finds no commit there"
changed=$(git -C "$root" status --porcelain | grep -c . || true)
((changed == 0)) || echo "Files with uncommitted changes, which are not tested: $changed"
clone="$place/root/tofsmith"
[[ -n "$keep" && -d "$clone/.git" ]] || rm -rf --one-file-system "$clone"
[[ -d "$clone" ]] || git clone -q --no-checkout "file://$root" "$clone"
git -C "$clone" fetch -q "file://$root" "$commit"
git -C "$clone" checkout -q --force --detach "$commit"

echo "Running $name in $place, commit ${commit:0:12}"
status=0
TIMEFORMAT="$release: %R s elapsed, %U s user, %S s system"
time enter sh -c 'cd tofsmith && exec "$@"' sh "${command[@]}" || status=$?
echo "$release: $name ended with exit status $status"
exit "$status"
