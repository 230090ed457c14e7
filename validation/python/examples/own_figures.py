# %% [markdown]
# # Fig. 10 and Fig. 11 by one's own plot
# The numbers come as arrays; what is drawn with them is free. Units: mm, deg, N, rad.

# %%
import deflect
import numpy as np
from matplotlib import pyplot

m = deflect.load("haptic-6psu")
print(m)

# %% [markdown]
# The paper's nine points: the centre of the workspace, and the corners of a cube of 50 mm, four above (1 to 4), four below.

# %%
corners = [(25, 25), (-25, 25), (-25, -25), (25, -25)]
offsets = np.array([(0, 0, 0)] + [(x, y, 25) for x, y in corners] + [(x, y, -25) for x, y in corners], dtype=float)
points = m.home[:3] + offsets

# One call for each direction of the force: (9, 6) by each theory, without a loop over poses.
along = {theory: np.empty((9, 3)) for theory in deflect.theories}
for axis in range(3):
    force = 50 * np.eye(3)[axis]
    for theory, d in m.displacement(points, force, theory="all").items():
        along[theory][:, axis] = d[:, axis]
print(np.round(along["analytic"], 6))

# %%
fig10 = pyplot.figure(figsize=(6.3, 4.2), layout="constrained")
upper, lower = fig10.subplots(2, 1, sharex=True, height_ratios=(3, 1))
for axis, (marker, colour) in enumerate(zip("osD", ("#0072B2", "#D55E00", "#009E73"))):
    at = np.arange(9) + 0.16 * (axis - 1)
    upper.plot(at, along["analytic"][:, axis], marker, color=colour, markersize=3, label=f"{'xyz'[axis]}, closed form")
    upper.plot(at, along["msa"][:, axis], marker, color=colour, markersize=7, fillstyle="none",
               label=f"{'xyz'[axis]}, MSA")
    lower.stem(at, 1e12 * (along["analytic"] - along["msa"])[:, axis], linefmt=colour, markerfmt=" ", basefmt="k-")
upper.set_ylabel("deflection along 50 N (mm)")
upper.legend(ncol=3, fontsize=8, loc="lower left", bbox_to_anchor=(0, 1), frameon=False)
lower.set_ylabel("difference (fm)")
lower.set_xlabel("point of the workspace")
lower.set_xticks(range(9))
fig10.savefig("fig10.png", dpi=110)

# %% [markdown]
# The result of `validate` has the same numbers, and a picture of its own.

# %%
study = deflect.validate(m)
largest = max(abs(p["analytic"]["xyz".index(p["load_axis"])] - along["analytic"][int(p["point"]), "xyz".index(p["load_axis"])])
              for p in study.points)
print(f"largest difference from validate: {largest:.1e} mm")
assert largest < 1e-12
study

# %% [markdown]
# Fig. 11: the stiffness in x over a slice through the centre. 3600 poses in one call.

# %%
x, z = np.meshgrid(np.linspace(-25, 25, 60), m.home[2] + np.linspace(-25, 25, 60))
poses = np.stack([x, 0 * x, z], axis=-1).reshape(-1, 3)
compliance = m.displacement(poses, [50, 0, 0])[:, 0] / 50
stiffness = (1 / compliance).reshape(x.shape)
print(f"from {stiffness.min():.1f} to {stiffness.max():.1f} N/mm")

fig11 = pyplot.figure(figsize=(5, 4), layout="constrained")
axes = fig11.subplots()
image = axes.pcolormesh(x, z, stiffness, norm="log", cmap="viridis", shading="gouraud")
curves = axes.contour(x, z, stiffness, [100, 200, 300, 500, 700, 1000], colors="w", linewidths=0.7)
axes.clabel(curves, fmt="%g")
axes.set_xlabel("x (mm)")
axes.set_ylabel("z (mm)")
bar = fig11.colorbar(image, label="stiffness along x (N/mm)", ticks=[150, 200, 300, 500, 700, 1000, 1500], format="{x:g}")
bar.minorticks_off()
fig11.savefig("fig11.png", dpi=110)

# %%
deflect.map(m, 15).plot().savefig("fig11-of-map.png", dpi=80)
