"""The page docs/research/practice_several.md from the diagnoses of scripts/make_several_causes_docs.sh.

    several_causes.py KEYS ANSWERS >docs/research/practice_several.md
"""
import json
import os
import sys

BELIEVED = 0.5  # probability above which an effect counts as named

keys = json.load(open(sys.argv[1]))
answers = sys.argv[2]
answered = {name: json.load(open(f'{answers}/{name}/diagnosis.json')) for name in sorted(keys) if os.path.exists(f'{answers}/{name}/diagnosis.json')}


def label(effect):
    return f"{effect['id']}@{effect['component']}"


class Judged:
    """One answer beside its key."""

    def __init__(self, name):
        self.key, self.answer = keys[name], answered[name]
        self.named = {label(e): e['probability'] for e in self.answer['effects'] if e['probability'] > BELIEVED}
        self.found = [any(one in self.named for one in acceptable) for acceptable in self.key['acceptable']]
        allowed = {one for acceptable in self.key['acceptable'] for one in acceptable}
        self.wrong = [one for one in self.named if one not in allowed]
        self.is_full = all(self.found) and not self.wrong


judged = {name: Judged(name) for name in answered}
versions = sorted({open(f'{answers}/{name}/version').read().strip() for name in answered})
cause_count = sum(len(j.found) for j in judged.values())
found_count = sum(sum(j.found) for j in judged.values())
wrong_count = sum(len(j.wrong) for j in judged.values())

print('# Practice plants with several causes\n')
print(f'<!-- Made by scripts/make_several_causes_docs.sh, diagnoses by {" and ".join(versions)}; do not edit. -->\n')
print('An independent program made recordings of plants with two to four causes. **They were used while the search was developed: the numbers are '
      'flattering.** [Withheld causes](blind.md) and [earlier checks](blind_history.md) have unseen ones. A cause is found if it, or one that the '
      f'measured signals cannot separate from it by the key, has a probability above {BELIEVED}; any other effect above it is wrong. A set is full '
      'if all its causes are found and none is wrong. *Left*: share of the gap on the recording that was held out.\n')
print(f'{found_count} of {cause_count} causes are found; {wrong_count} wrong {"one is" if wrong_count == 1 else "ones are"} named; {sum(j.is_full for j in judged.values())} of '
      f'{len(judged)} sets are full.' + ('' if len(judged) == len(keys) else f' Not diagnosed: {", ".join(sorted(set(keys) - set(judged)))}.') + '\n')
print('| case | robot | true causes, noise floors that each makes | found | wrong | probability of the causes | verdict | left | simulations | s, one core |')
print('|---' * 10 + '|')
for name, j in judged.items():
    causes = [f'`{label(e)}` ({floors:.0f})' for e, floors in zip(j.key['effects'], j.key['contribution_over_noise'])]
    every = {label(e): e['probability'] for e in j.answer['effects']}
    chances = [max((every.get(one, 0.0) for one in acceptable), default=0.0) for acceptable in j.key['acceptable']]
    cost = j.answer['cost']
    print(f"| {name[4:]} | {j.key['robot']} | {', '.join(causes)} | {sum(j.found)} of {len(j.found)} | "
          f"{', '.join(f'`{one}` {j.named[one]:.2f}' for one in j.wrong)} | {', '.join(f'{p:.2f}' for p in chances)} | {j.answer['verdict']} | "
          f"{j.answer['unexplained_percent']:.2f} % | {cost['simulations']} | {cost['wall_s']:.0f} |")
