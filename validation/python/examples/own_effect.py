# %% [markdown]
# # An effect of one's own, written in Python
# A rubber pad between platform and tool is soft at first and then hardens. No entry of the catalogue says that. A curve in
# Python becomes a law that both theories solve, and an effect that `diagnose` takes among its candidates.

# %%
import deflect
import numpy as np
from matplotlib import pyplot

model = deflect.load("haptic-6psu-ideal-joints")


def pad_curve(depth_mm):
    """Deflection (mm) over force (N): up to `depth` however large the force is; half of it at 15 N."""
    return lambda f: depth_mm * f / (f + 15)


# %% [markdown]
# ## The law, in both theories
# `deflect.law` reads the curve at the given forces: straight pieces between them, the same under push as under pull.

# %%
forces = [0, 1, 2, 3, 4, 6, 8, 10, 13, 16, 20, 25, 30, 40, 50, 70, 100]
with_pad = model.edited("tool.tz", deflect.law(pad_curve(0.1), forces), "append")
for force in (10, -10, 50):
    both = {name: answer.displacement[2] for name, answer in with_pad.solve(load=[0, 0, force]).by_theory.items()}
    alone = model.solve(load=[0, 0, force]).displacement[2]
    print(f"{force:4} N: " + ", ".join(f"{name} {d - alone:.9f} mm" for name, d in both.items())
          + f"; the curve {np.sign(force) * pad_curve(0.1)(abs(force)):.9f} mm")

# %% [markdown]
# ## The effect: the same, with a parameter
# The dict of an effect file, whose `edits` is a function of the parameters.

# %%
pad = {
    "name": "rubber_pad",
    "title": "A rubber pad between platform and tool hardens as it is pressed",
    "scope": "machine",
    "parameters": {"depth_mm": {"start": 0.05, "low": 0.001, "high": 1, "scale": "log", "vanishes": 0,
                                "about": "how far the pad can be pressed, mm"}},
    "edits": lambda p: [{"at": "tool.tz", "append": deflect.law(pad_curve(p["depth_mm"]), forces)}],
}
print(model.with_effect(pad, depth_mm=0.1) == with_pad)

# %% [markdown]
# ## Found among all others
# The laboratory has the pad; first the program does not know it, then it does.

# %%
data = deflect.simulate(model, ("rubber_pad", {"depth_mm": 0.1}), effects=[pad], seed=2)
closed = deflect.diagnose(model, data, bootstrap=199)
print(closed.verdict, closed.missing)

# %%
opened = deflect.diagnose(model, data, effects=[pad], bootstrap=199)
print(opened.sentence)
value = opened.found[0]["parameters"][0]
print(f"depth {value['value']:.4f} mm [{value['low95']:.4f}, {value['high95']:.4f}]; hidden was 0.1")
assert opened.missing == ["rubber_pad"]
opened.plot().savefig("own-effect.png", dpi=110)
opened

# %% [markdown]
# ## Fitted beside a number
# `fit` takes it too, here beside the modulus, of which 1 % is known before.

# %%
fitted = deflect.fit(model, data, [pad, "materials.steel.E"], prior={"materials.steel.E": "210 GPa ± 1 %"})
for p in fitted.parameters:
    print(f"{p.path:22} {p.value:.5g} [{p.low95:.5g}, {p.high95:.5g}] {p.unit}")
print(f"correlation {fitted.correlation[0, 1]:.2f}")
depth = fitted.parameters[1]
assert depth.low95 < 0.1 < depth.high95
fitted.plot().savefig("own-fit.png", dpi=110)

# %%
named = model.with_effect(pad, depth_mm=value["value"]).named("with the pad")
fall = deflect.history(data, [model, named])
fall.plot().savefig("own-history.png", dpi=110)
fall

# %%
figure = pyplot.figure(figsize=(5, 3.2), layout="constrained")
axes = figure.subplots()
z = np.linspace(-60, 60, 241)
at_home = np.tile(model.home, (len(z), 1))
loads = np.zeros((len(z), 6))
loads[:, 2] = z
for machine, name in ((model, "model"), (named, "with the pad")):
    axes.plot(z, machine.displacement(at_home, loads)[:, 2], label=name)
axes.set_xlabel("force along z (N)")
axes.set_ylabel("displacement along z (mm)")
axes.legend()
figure.savefig("own-curve.png", dpi=110)
