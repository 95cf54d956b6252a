"""The screen: figures of many cams at once, sampled by closed formulas; estimates, which no verdict rests on."""
