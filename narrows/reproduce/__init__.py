"""Figures of papers, computed again: `narrows reproduce`.

| module | holds |
|---|---|
| `results` | numbers beside the paper's, and when they agree |
| `paper_figure` | what a figure of a paper is: scenes, and what is made of their runs |
| `session` | runs what is missing, makes the figures, writes the files |
| `page` | `index.html` |
| `drawing` | the look of the figures |
| `tabatabaei_2009` | the thesis on colloids in a narrow channel |
"""
