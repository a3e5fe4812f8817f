#!/bin/sh
# Installs the Debian packages that ROEVO needs, as root or through sudo, asking nothing.
set -eu
cd "$(dirname "$0")/.."
. scripts/set_up.sh
install_packages $roevo_batch_packages
echo "All packages are there."
