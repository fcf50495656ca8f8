"""Writes the files in this folder by the programs that people use: pandas, NumPy, GeoPandas, pyshp."""
import struct
import numpy as np, pandas as pd
frame = pd.DataFrame({"town": ["Ulm", "Bonn", "Kiel", "Köln", "Hof"],
                      "x": [0.5, 10.25, None, 10.0, 90.0], "y": [0, 1, 3, 10, 90],
                      "kind": ["a", None, "b", "a", "c"]})
frame.to_csv("pandas.csv")
frame.to_csv("pandas-german.csv", sep=";", decimal=",", index=False)
frame.to_parquet("pandas.parquet", compression=None)
rng = np.random.default_rng(1)
cloud = np.round(rng.normal(size=(12, 3)), 2)
np.savez("stored.npz", cloud=cloud, other=np.arange(6.0).reshape(3, 2))
np.savez_compressed("packed.npz", cloud)
import geopandas as gpd
from shapely.geometry import Point, Polygon
gpd.GeoDataFrame({"name": ["a", "b", "c"]}, geometry=[Point(1, 2), Point(3.5, -1), Point(0, 0.25)]).to_parquet("points.geo.parquet")
square = Polygon([(0, 0), (8, 0), (8, 6), (0, 6)], [[(1, 1), (2, 1), (2, 2)]])
gpd.GeoDataFrame({"name": ["a"]}, geometry=[square]).to_parquet("polygon.geo.parquet")
import shapefile
with shapefile.Writer("points", shapeType=shapefile.POINT) as w:
    w.field("name"); [(w.point(*p), w.record("p")) for p in [(1, 2), (3.5, -1), (0, 0.25)]]
with shapefile.Writer("heights", shapeType=shapefile.POINTZ) as w:
    w.field("name"); [(w.pointz(*p), w.record("p")) for p in [(1, 2, 3), (3.5, -1, 0.5)]]
with shapefile.Writer("multi", shapeType=shapefile.MULTIPOINT) as w:
    w.field("name"); w.multipoint([(1, 2), (3, 4)]); w.record("m"); w.multipoint([(5, 6)]); w.record("m")
with shapefile.Writer("polygons", shapeType=shapefile.POLYGON) as w:
    w.field("name")
    w.poly([[(0, 0), (0, 6), (8, 6), (8, 0), (0, 0)], [(1, 1), (2, 1), (2, 2), (1, 1)]]); w.record("hole")
    w.poly([[(20, 0), (20, 1), (21, 1), (20, 0)]]); w.record("small")
with shapefile.Writer("line", shapeType=shapefile.POLYLINEZ) as w:
    w.field("name"); w.linez([[(0, 0, 5), (1, 1, 6), (2, 0, 7)]]); w.record("line")
def lzf(data):  # literals alone, as any LZF reader takes them
    out = b""
    for i in range(0, len(data), 32):
        piece = data[i:i + 32]; out += bytes([len(piece) - 1]) + piece
    return out
head = lambda kind, n: (f"# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z intensity normal\nSIZE 4 4 4 2 4\n"
    f"TYPE F F F U F\nCOUNT 1 1 1 1 3\nWIDTH {n}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {n}\nDATA {kind}\n").encode()
pts = cloud.astype("<f4"); n = len(pts); inten = np.arange(n, dtype="<u2"); nor = np.tile(np.array([0, 0, 1], "<f4"), (n, 1))
open("ascii.pcd", "wb").write(head("ascii", n) + b"".join(f"{a!s} {b!s} {c!s} {i} 0 0 1\n".encode() for (a, b, c), i in zip(pts, inten)))
open("binary.pcd", "wb").write(head("binary", n) + b"".join(p.tobytes() + struct.pack("<H", i) + m.tobytes() for p, i, m in zip(pts, inten, nor)))
soa = pts[:, 0].tobytes() + pts[:, 1].tobytes() + pts[:, 2].tobytes() + inten.tobytes() + nor.tobytes()
packed = lzf(soa)
open("compressed.pcd", "wb").write(head("binary_compressed", n) + struct.pack("<II", len(packed), len(soa)) + packed)
np.savetxt("cloud.csv", cloud, delimiter=",", fmt="%.17g"); np.savetxt("cloud32.csv", pts.astype(float), delimiter=",", fmt="%.17g")
