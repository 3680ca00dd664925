"use strict";document.documentElement.dataset.page="placeholder";
