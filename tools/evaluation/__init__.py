"""The figures of facewire, measured against truth; run through tools/eval. README.md explains each."""
