# %% [markdown]
# # A missing effect, found by hand and by `diagnose`
# The laboratory is simulated: its machine has guideways whose roots yield, and the model does not know. First we look for
# it by hand, as one does; then the program does.

# %%
import deflect
import numpy as np

model = deflect.load("haptic-6psu-ideal-joints")
data = deflect.simulate(model, ("guide_root_compliance", {"stiffness_Nmm_per_rad": 5e6}), seed=7)
print(len(data), "readings of three components at", len(set(data.columns["pose"])), "poses")

# %% [markdown]
# ## 1. Does the model fail, and how?

# %%
compared = deflect.compare(model, data)
compared.plot().savefig("residuals.png", dpi=110)
print(compared.verdict)
compared

# %% [markdown]
# The misfit is many times what noise and tolerances allow, and its findings say what it looks like.
#
# ## 2. The first suspect: the modulus
# A softer steel makes the error fall by far. That proves nothing: look at the value that it needs.

# %%
fitted = deflect.fit(model, data, "materials.steel.E")
E = fitted.parameters[0]
print(f"E = {E['value']:.1f} GPa [{E['low95']:.1f}, {E['high95']:.1f}], tabulated 210 GPa, known to 1 %")
print(f"rms {1e3 * fitted.before['rmse_mm']:.1f} µm -> {1e3 * fitted.after['rmse_mm']:.1f} µm, "
      f"noise {1e3 * fitted.noise_floor_mm:.1f} µm")
assert abs(E["value"] / 210 - 1) > 0.03
fitted.plot().savefig("modulus.png", dpi=110)

# %% [markdown]
# ## 3. Other compliances, one after the other
# For each the value that fits best, by a scan: `compare` knows noise and tolerances, so its χ² per degree of freedom is 1
# where nothing is missing.

# %%
def scan(effect, parameter, low, high):
    """(χ² per degree of freedom, value) where it is least: nine values over all, then nine between the best's neighbours."""
    for _ in range(2):
        values = np.geomspace(low, high, 9)
        chi2 = [deflect.compare(model.with_effect(effect, **{parameter: v}), data).baseline["chi2_per_dof"] for v in values]
        i = int(np.argmin(chi2))
        low, high = values[max(i - 1, 0)], values[min(i + 1, 8)]
    return chi2[i], values[i]


suspects = {"guide_root_compliance": ("stiffness_Nmm_per_rad", 1e6, 1e8),
            "carriage_compliance": ("stiffness_N_per_mm", 300, 3e4),
            "joint_compliance": ("stiffness_N_per_mm", 300, 3e4)}
best = {}
for effect, (parameter, low, high) in suspects.items():
    best[effect] = scan(effect, parameter, low, high)
    print(f"{effect:24} chi2/dof {best[effect][0]:6.3f} at {best[effect][1]:.3g} {parameter}")

# %% [markdown]
# One of them explains the data to the noise. The others do not, close as they come: of 2160 numbers χ² per degree of freedom
# has the standard deviation √(2/2160) = 0.03.

# %%
found = min(best, key=lambda effect: best[effect][0])
by_hand = model.with_effect(found, **{suspects[found][0]: best[found][1]}).named("by hand")
assert found == "guide_root_compliance"

# %% [markdown]
# ## 4. The program's way
# All effects of the catalogue and all laws at all places, with their probabilities, held-out poses and a placebo.

# %%
diagnosed = deflect.diagnose(model, data, bootstrap=499)
print(diagnosed.sentence)
diagnosed.plot().savefig("diagnosis.png", dpi=110)
assert diagnosed.missing == ["guide_root_compliance"]
diagnosed

# %%
value = diagnosed.found[0]["parameters"][0]
print(f"{value['value']:.3g} [{value['low95']:.3g}, {value['high95']:.3g}] Nmm/rad; hidden was 5e6")
assert value["low95"] < 5e6 < value["high95"]

# %% [markdown]
# ## 5. The error falling

# %%
by_program = model.with_effect("guide_root_compliance", stiffness_Nmm_per_rad=value["value"]).named("diagnosed")
fall = deflect.history(data, [model, fitted.model.named("softer steel"), by_hand, by_program])
fall.plot().savefig("history.png", dpi=110)
fall
