# %% [markdown]
# # An optimal measurement plan
# What can a campaign tell before it is measured? And which readings tell two effects apart that look alike?

# %%
import deflect

model = deflect.load("haptic-6psu-ideal-joints")

# %% [markdown]
# ## Before measuring
# The paper pushes with 50 N in x, y and z at nine points. With the same number of readings one can learn more.

# %%
foreseen = deflect.plan(model, before="paper", seed=3)
for name in ("given", "better"):
    one = foreseen.content[name]
    print(f"{name:7} {one['readings']} readings tell {one['pairs_told_apart']} of {one['pairs']} pairs of effects apart; "
          f"chance of confusion {one['chance_of_confusion']:.4f}")
assert foreseen.better["pairs_told_apart"] >= foreseen.given["pairs_told_apart"]
foreseen.plot().savefig("alike.png", dpi=110)
foreseen

# %% [markdown]
# The plan is a file to be filled in by the laboratory.

# %%
foreseen.measurements.to_csv("better.csv")
foreseen.measurements

# %% [markdown]
# ## After a diagnosis that ends in a tie
# A machine whose platform yields, measured as in the paper. A platform and an actuator that yield look alike under forces.

# %%
hidden = ("platform_flexibility", {"stiffness_N_per_mm": 1500})
paper = deflect.simulate(model, hidden, campaign="paper", seed=5)
first = deflect.diagnose(model, paper, bootstrap=199)
print(first.verdict, first.indistinguishable)
assert first.verdict == "ambiguous"

# %% [markdown]
# Which readings tell them apart? Each is chosen for what it adds to those before it.

# %%
more = deflect.plan(model, first, paper, seed=1)
print(f"{len(more.readings)} further readings: the right effect is expected with probability {more.probability:.3f}")
print(more.measurements.text.splitlines()[0])
for line in more.measurements.text.splitlines()[1:4]:
    print(line)
more.plot().savefig("next.png", dpi=110)
more

# %% [markdown]
# The laboratory fills in the plan, on the same machine; both sessions together give the verdict.

# %%
filled = deflect.simulate(model, hidden, campaign=more.measurements, seed=6, machine=5)
second = deflect.diagnose(model, [paper, filled], bootstrap=199)
print(second.sentence)
assert second.missing == ["platform_flexibility"]
second.plot().savefig("second.png", dpi=110)
second
