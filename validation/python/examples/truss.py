# %% [markdown]
# # A truss in the laboratory
# A frame is measured like a machine: load cases instead of poses, named sensors instead of the tool point.

# %%
import deflect

truss = deflect.load("truss-45")
print(truss)
for sensor in truss.sensors():
    print(f"  {sensor.name}: {sensor.unit}" + ("" if sensor.sigma is None else f", sigma {sensor.sigma:g}"))
print("load cases:", ", ".join(truss.load_cases))

# %%
solved = truss.solve()
solved.plot().savefig("truss.png", dpi=110)
members = solved.members(truss.load_cases[0])
most = abs(members["start.N_N"]).argmax()
print(f"largest force: {members['start.N_N'][most]:.0f} N in {members['member'][most]}")
solved

# %% [markdown]
# ## What can be missing, and where
# Every place of the frame with the laws that physics allows there.

# %%
print(len(truss.places()), "places,", len(truss.effects()), "effects")

# %% [markdown]
# ## The laboratory's truss has a support that yields
# Its readings, with noise and the tolerances of the file.

# %%
supports = [e["effect"] for e in truss.effects() if e["effect"].startswith("linear@support.")]
hidden = supports[-1]
stiffness = next(e for e in truss.effects() if e["effect"] == hidden)["parameters"][0]
print(hidden, stiffness["name"])
data = deflect.simulate(truss, (hidden, {stiffness["name"]: 2000.0}), campaign="rich", seed=4)
data

# %%
compared = deflect.compare(truss, data)
print(compared.verdict)
compared.plot().savefig("truss-residuals.png", dpi=110)
compared

# %%
diagnosed = deflect.diagnose(truss, data, bootstrap=199)
print(diagnosed.sentence)
diagnosed.plot().savefig("truss-diagnosis.png", dpi=110)
named = diagnosed.missing + [e for tie in diagnosed.indistinguishable for e in tie]
assert any(hidden in str(each) for each in named), named
diagnosed

# %%
fall = deflect.history(data, [truss, truss.with_effect(hidden, **{stiffness["name"]: 2000.0}).named("with the support")])
fall.plot().savefig("truss-history.png", dpi=110)
fall
