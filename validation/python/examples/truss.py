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
# ## The laboratory's truss has a cracked brace
# It has 30 % of its stiffness. The readings have noise, and the truss differs from its drawing by the tolerances of the file.

# %%
data = deflect.simulate(truss, ("factor@D1bc", {"factor": 0.3}), seed=4)
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
assert diagnosed.missing == ["factor@D1bc"]
diagnosed

# %%
value = diagnosed.found[0]["parameters"][0]
print(f"factor {value['value']:.3f} [{value['low95']:.3f}, {value['high95']:.3f}]; hidden was 0.3")
cracked = truss.with_effect("factor@D1bc", factor=value["value"]).named("with the cracked brace")
fall = deflect.history(data, [truss, cracked])
fall.plot().savefig("truss-history.png", dpi=110)
fall
