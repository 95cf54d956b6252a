"""Made cams: what points measured on the metal say of its form, and of the motion that it will make."""
