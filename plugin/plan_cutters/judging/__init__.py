"""One module a stage, independent of each other; `pipeline` alone knows their order. May use: scene, domain, kernels."""
