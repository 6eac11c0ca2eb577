"""Files of motions and bodies in the formats of other programs.

Quaternion order, direction and frames are those that a file states. Where a file does not state them, they
must be given as arguments; they are never guessed.
"""

from polhode._io.aem import read_aem
from polhode._io.aem_writing import write_aem
from polhode._io.convert import read, write
from polhode._io.gltf import write_gltf
from polhode._io.history import AttitudeHistory, FileError
from polhode._io.members import read_netcdf, read_zarr
from polhode._io.meshes import read_mesh, solid_surface, write_stl
from polhode._io.robots import write_mjcf, write_urdf
from polhode._io.spice import read_ck, write_ck
from polhode._io.spice_frames import CkFrame, FrameVector, TwoVectorFrame, write_fk, write_sclk
from polhode._io.tables import read_csv, read_parquet

__all__ = [
    "AttitudeHistory",
    "CkFrame",
    "FileError",
    "FrameVector",
    "TwoVectorFrame",
    "read",
    "read_aem",
    "read_ck",
    "read_csv",
    "read_mesh",
    "read_netcdf",
    "read_parquet",
    "read_zarr",
    "solid_surface",
    "write",
    "write_aem",
    "write_ck",
    "write_fk",
    "write_gltf",
    "write_mjcf",
    "write_sclk",
    "write_stl",
    "write_urdf",
]


def __dir__() -> list[str]:
    return sorted(__all__)
