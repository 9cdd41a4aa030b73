#!/usr/bin/python3
"""3D non-local means beside scikit-image's fast mode: same windows (21/5), same volume, one after the other.

    sudo apt-get install python3-skimage
    bench/non_local_means_peer.py build/release/bench/craze_bench_non_local_means

scikit-image runs on one thread, its only choice, for some six minutes: its processor time counts, which other
work on the machine hardly touches. craze runs on all cores, its wall time counts."""
import json
import subprocess
import sys
import time

import numpy as np
from skimage.restoration import denoise_nl_means

NX, NY, NZ = 428, 80, 48  # as non_local_means_peer in non_local_means_bench.cpp

said = subprocess.run([sys.argv[1], "--benchmark_filter=peer", "--benchmark_format=json"], check=True,
                      capture_output=True, text=True).stdout
ours = json.loads(said)["benchmarks"][0]["us/voxel"]

z, y, _ = np.mgrid[0:NZ, 0:NY, 0:NX]
volume = np.where((y + z // 2) % 61 < 2, 45.0, 165.0) + np.random.default_rng(1).normal(0, 12, (NZ, NY, NX))
start = time.process_time()
denoise_nl_means(np.clip(volume, 0, 255), patch_size=5, patch_distance=10, h=7.2, sigma=12.0, fast_mode=True)
theirs = (time.process_time() - start) / volume.size * 1e6

print(f"scikit-image {theirs:.1f} us/voxel, craze {ours:.2f} us/voxel: {theirs / ours:.0f} times")
