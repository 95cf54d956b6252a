"""The follower train as an oscillator with separation and impacts."""
