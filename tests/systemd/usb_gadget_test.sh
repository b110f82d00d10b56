#!/bin/bash
# The USB gadget's script, on a folder that behaves as the kernel's configfs does where the script relies on it: a
# folder comes with files of its own, which go with it, and one that is in use stays.
# usage: usb_gadget_test.sh SCRIPT SCRATCH_FOLDER
set -u
script=$1
scratch=$2
failed=0
export FACEWIRE_ROOT=$scratch/root FACEWIRE_UDC_WAIT_S=0
gadgets=$FACEWIRE_ROOT/sys/kernel/config/usb_gadget
gadget=$gadgets/facewire

rm -rf "$scratch"
mkdir -p "$scratch/bin"
cat >"$scratch/bin/rmdir" <<'STUB'
#!/bin/bash
folder=$1
case $folder in
  */.) false ;;
  */facewire | */configs/c.1) [ -z "$(find "$folder" -mindepth 1 \( -type l -o -name 0x409 -o -name c.1 -o -name acm.GS0 \))" ] ;;
  */acm.GS0) [ -z "$(find "$folder/../../configs" -type l)" ] ;;
esac || { echo "rmdir: $1: Device or resource busy" >&2; exit 1; }
rm -r "$folder"
STUB
chmod +x "$scratch/bin/rmdir"

fail() { printf 'FAILED: %s: %s\n' "$test" "$*" >&2; failed=1; }
gadget_script() { PATH=$scratch/bin:$PATH "$script" "$@" 2>"$scratch/said"; }
holds() { # TEXT FILE
  [ "$(cat "$2" 2>/dev/null)" = "$1" ] || fail "$2 holds '$(cat "$2" 2>/dev/null)' instead of '$1'"
}
fresh_board() {
  rm -rf "$FACEWIRE_ROOT"
  mkdir -p "$gadgets" "$FACEWIRE_ROOT/sys/class/udc" "$FACEWIRE_ROOT/etc"
  echo 0123456789abcdef0123456789abcdef >"$FACEWIRE_ROOT/etc/machine-id"
}
controller() { mkdir "$FACEWIRE_ROOT/sys/class/udc/$1"; }

test="starting makes a serial device and gives it to the controller"
fresh_board
controller fe980000.usb
gadget_script start || fail "$(cat "$scratch/said")"
holds fe980000.usb "$gadget/UDC"
holds 0x1d6b "$gadget/idVendor"
holds 0x0104 "$gadget/idProduct"
[ -L "$gadget/configs/c.1/acm.GS0" ] || fail "the function is not in the configuration"
serial=$(cat "$gadget/strings/0x409/serialnumber")
[[ $serial =~ ^[0-9a-f]{16}$ ]] || fail "the serial number is '$serial'"

test="starting again changes nothing"
gadget_script start || fail "$(cat "$scratch/said")"
holds fe980000.usb "$gadget/UDC"

test="stopping removes everything, and again nothing"
gadget_script stop || fail "$(cat "$scratch/said")"
[ ! -e "$gadget" ] || fail "$gadget is still there"
gadget_script stop || fail "$(cat "$scratch/said")"

test="a board has the same serial number every time, and another board another"
gadget_script start || fail "$(cat "$scratch/said")"
holds "$serial" "$gadget/strings/0x409/serialnumber"
gadget_script stop
echo 1123456789abcdef0123456789abcdef >"$FACEWIRE_ROOT/etc/machine-id"
gadget_script start
[ "$(cat "$gadget/strings/0x409/serialnumber")" != "$serial" ] || fail "both have $serial"
gadget_script stop

test="a board's own serial number is used"
mkdir -p "$FACEWIRE_ROOT/proc/device-tree"
printf '10000000abcdef01\0' >"$FACEWIRE_ROOT/proc/device-tree/serial-number"
gadget_script start || fail "$(cat "$scratch/said")"
holds 10000000abcdef01 "$gadget/strings/0x409/serialnumber"

test="what an interrupted start left is no obstacle"
: >"$gadget/UDC"
gadget_script start || fail "$(cat "$scratch/said")"
holds fe980000.usb "$gadget/UDC"

test="a controller that another gadget holds is left to it"
fresh_board
controller first.usb
controller second.usb
mkdir "$gadgets/other"
echo first.usb >"$gadgets/other/UDC"
gadget_script start || fail "$(cat "$scratch/said")"
holds second.usb "$gadget/UDC"

test="without a controller it fails, says why, and leaves nothing"
fresh_board
! gadget_script start || fail "it succeeded"
grep -q 'dtoverlay=dwc2' "$scratch/said" || fail "it said: $(cat "$scratch/said")"
[ ! -e "$gadget" ] || fail "$gadget is there"

test="a controller that comes late is waited for"
fresh_board
(sleep 0.5; controller late.usb) &
FACEWIRE_UDC_WAIT_S=20 gadget_script start || fail "$(cat "$scratch/said")"
wait
holds late.usb "$gadget/UDC"

test="without configfs it fails and says why"
rm -rf "$FACEWIRE_ROOT/sys/kernel"
! gadget_script start || fail "it succeeded"
grep -q 'libcomposite' "$scratch/said" || fail "it said: $(cat "$scratch/said")"

test="bad usage ends with 2"
gadget_script
[ $? -eq 2 ] || fail "no argument"
gadget_script begin
[ $? -eq 2 ] || fail "an unknown word"
exit $failed
