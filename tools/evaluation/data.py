"""Reads the folder of reference data. Each part may be missing; then the figures that need it are left out."""
import csv
import gzip
import json
import pathlib

import numpy as np

from evaluation.report import LeftOut


class Data:
    def __init__(self, folder):
        self.folder = pathlib.Path(folder).resolve()

    def path(self, name):
        path = self.folder / name
        if not path.exists():
            raise LeftOut(f"there is no {name} in the data folder")
        return path

    def json(self, name):
        with gzip.open(self.path(name), "rt") as file:
            return json.load(file)

    def json_lines(self, name):
        with gzip.open(self.path(name), "rt") as file:
            return [json.loads(line) for line in file]

    def truth(self, person):
        """Names of the shapes, and frames x shapes."""
        truth = self.json(f"synth/{person}/truth.json.gz")
        return truth["weight_names"], np.array([row["w"] for row in truth["rows"]])

    def neutral_markers(self, person):
        """68 x 3, cm."""
        with open(self.path(f"synth/{person}/neutral_markers.csv"), newline="") as file:
            return np.array([[float(v) for v in row[1:4]] for row in list(csv.reader(file))[1:]])

    def pair_markers(self, person):
        """Names of the markers, and frames x 68 x 3, cm, 100 frames a second."""
        names, values = read_csv_gz(self.path(f"synth/{person}/pair_markers.csv.gz"))
        return [n[:-2] for n in names[2::3]], values[:, 2:].reshape(len(values), -1, 3)

    def pair_weights(self):
        """Names of the shapes, and frames x shapes: what the rows of pair_markers show, on every person."""
        names, values = read_csv_gz(self.path("synth/pair_markers_weights.csv.gz"))
        return names[2:], values[:, 2:]


def read_csv_gz(path):
    with gzip.open(path, "rt") as file:
        names = file.readline().strip().split(",")
        return names, np.loadtxt(file, delimiter=",", ndmin=2)
