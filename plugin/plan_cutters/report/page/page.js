/*! This page contains:

three 0.187.0

The MIT License

Copyright (c) 2010-2026 three.js authors

Permission is hereby granted, free of charge, to any person obtaining a copy
of this software and associated documentation files (the "Software"), to deal
in the Software without restriction, including without limitation the rights
to use, copy, modify, merge, publish, distribute, sublicense, and/or sell
copies of the Software, and to permit persons to whom the Software is
furnished to do so, subject to the following conditions:

The above copyright notice and this permission notice shall be included in
all copies or substantial portions of the Software.

THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR
IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY,
FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE
AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER
LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM,
OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN
THE SOFTWARE.

----

three-mesh-bvh 0.9.17

MIT License

Copyright (c) 2018 Garrett Johnson

Permission is hereby granted, free of charge, to any person obtaining a copy
of this software and associated documentation files (the "Software"), to deal
in the Software without restriction, including without limitation the rights
to use, copy, modify, merge, publish, distribute, sublicense, and/or sell
copies of the Software, and to permit persons to whom the Software is
furnished to do so, subject to the following conditions:

The above copyright notice and this permission notice shall be included in all
copies or substantial portions of the Software.

THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR
IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY,
FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE
AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER
LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM,
OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN THE
SOFTWARE.
*/
"use strict";(()=>{var ts=["free","axis_limit","no_contact","local_gouge","rear_gouge","collision","neck","shank","holder","fixture","undecided","tolerance","buried"],Qh=["holder","fixture","shank","neck","collision","rear_gouge","local_gouge"];var jh="<0.1 %",tf=">99.9 %";function ef(i,t,e){for(let[n,s]of Object.entries(t))s===null||s===!1||i.setAttribute(n,s===!0?"":String(s));i.append(...e.filter(n=>n!==null))}function Y(i,t={},...e){let n=document.createElement(i);return ef(n,t,e),n}function $t(i,t={},...e){let n=document.createElementNS("http://www.w3.org/2000/svg",i);return ef(n,t,e),n}function re(i,t,e={}){let n=Y("button",{type:"button",...e},i);return n.addEventListener("click",t),n}function Je(i,t=3){return Number.isFinite(i)?Math.abs(i)<1e-9?"0":Number(i.toPrecision(Math.max(t,Math.ceil(Math.log10(Math.abs(i)+1))))).toLocaleString("en",{useGrouping:!1,maximumFractionDigits:12}):"unknown"}function vs(i){let t=Number(i.toFixed(1));return String(t===360||Object.is(t,-0)?0:t)}function bo(i){if(i<=0||i>=1)return i>=1?"100 %":"0 %";let t=(100*i).toFixed(1);return t==="0.0"?jh:t==="100.0"?tf:`${Number(t)} %`}var nf={plain:{size:8,lines:[]},hatch:{size:7,lines:[[0,7,7,0],[-1,1,1,-1],[6,8,8,6]]},back:{size:7,lines:[[0,0,7,7],[-1,6,1,8],[6,-1,8,1]]},cross:{size:8,lines:[[0,0,8,8],[0,8,8,0]]},bars:{size:5,lines:[[0,2.5,5,2.5]]},lines:{size:5,lines:[[2.5,0,2.5,5]]},dots:{size:5,lines:[],dots:!0}},Pc=i=>`rgb(${oi(i).map(t=>Math.round(t*.45)).join(" ")})`;function sf(i,t,e){let{size:n,lines:s,dots:r}=nf[e];if(!s.length&&!r)return t;let o=i.getTransform().a||1,l=document.createElement("canvas");l.width=l.height=Math.round(n*o);let a=l.getContext("2d");a.scale(l.width/n,l.width/n),a.fillStyle=t,a.fillRect(0,0,n,n),a.strokeStyle=a.fillStyle=Pc(t),a.lineWidth=1.2,a.beginPath();for(let[u,h,f,d]of s)a.moveTo(u,h),a.lineTo(f,d);a.stroke(),r&&(a.beginPath(),a.arc(n/2,n/2,1.1,0,7),a.fill());let c=i.createPattern(l,"repeat");return c.setTransform(new DOMMatrix().scale(1/o)),c}var Jm=0;function es(i,t){let{size:e,lines:n,dots:s}=nf[t],r=`tile-${Jm++}`,o=n.map(([l,a,c,u])=>$t("line",{x1:l,y1:a,x2:c,y2:u,stroke:Pc(i),"stroke-width":1.3}));return $t("svg",{class:"swatch",width:22,height:14,"aria-hidden":"true"},$t("pattern",{id:r,width:e,height:e,patternUnits:"userSpaceOnUse"},$t("rect",{width:e,height:e,fill:i}),...o,s?$t("circle",{cx:e/2,cy:e/2,r:1.2,fill:Pc(i)}):null),$t("rect",{x:.5,y:.5,width:21,height:13,fill:`url(#${r})`,stroke:"#00000055"}))}function ns(i,t){let e=document.createElement("button");return e.type="button",e.className="text",e.append(...i.childNodes),i.append(e),e.addEventListener("click",t),e}function Ms(i){let t=i.nextElementSibling;return t?.classList.contains("more")?t:null}function Ic(i,t=()=>!1){let e=[...i.tHead?.rows[0]?.cells??[]].filter(s=>s.textContent.trim()!==""),n=i.tBodies[0];if(n)for(let s of e)ns(s,()=>{let r=s.getAttribute("aria-sort")!=="ascending";for(let c of e)c.removeAttribute("aria-sort");s.setAttribute("aria-sort",r?"ascending":"descending");let o=s.cellIndex,a=[...n.rows].filter(c=>!c.classList.contains("more")).map(c=>({row:c,more:Ms(c)}));a.sort((c,u)=>Number(t(u.row))-Number(t(c.row))||(r?1:-1)*Km(c.row.cells[o],u.row.cells[o])),n.append(...a.flatMap(({row:c,more:u})=>u?[c,u]:[c]))})}function Km(i,t){let[e,n]=[i,t].map(o=>o?.dataset.sort??o?.textContent?.trim()??""),[s,r]=[e,n].map(o=>Number.parseFloat(o.replace(/^[F<>\s]+|,/g,"")));return Number.isFinite(s)&&Number.isFinite(r)?s-r:e.localeCompare(n,"en",{numeric:!0})}var It=(i,t)=>i[0]*t[0]+i[1]*t[1]+i[2]*t[2],ce=(i,t,e=1)=>[i[0]+e*t[0],i[1]+e*t[1],i[2]+e*t[2]],Rn=(i,t)=>[i[0]-t[0],i[1]-t[1],i[2]-t[2]],Ei=(i,t)=>[i[0]*t,i[1]*t,i[2]*t],He=(i,t,e,n)=>ce(Ei(i,t),e,n),Ss=i=>Math.hypot(i[0],i[1],i[2]),Le=(i,t)=>[i[1]*t[2]-i[2]*t[1],i[2]*t[0]-i[0]*t[2],i[0]*t[1]-i[1]*t[0]],is=(i,t)=>Ss(Rn(i,t)),Ri=(i,t=1)=>[0,1,2].map(e=>e===i?t:0);function yr(i){let t=Ss(i);return t>0?Ei(i,1/t):[0,0,1]}function Ci(i){let t=i.map(Math.abs),e=t.indexOf(Math.min(...t));return yr(Le(Ri(e),i))}function wo(i,t){let e=1-Math.abs(i)-Math.abs(t),n=e<0?(1-Math.abs(t))*(i<0?-1:1):i,s=e<0?(1-Math.abs(i))*(t<0?-1:1):t,r=Math.sqrt(n*n+s*s+e*e);return[n/r,s/r,e/r]}var Ne=Math.PI/180,fn=180/Math.PI,ai=i=>(i%360+360)%360,bs=(i,t)=>Math.abs((i-t+540)%360-180);var Qm="operation:",ss=i=>Qm+i.key,vr=({name:i})=>`${i.charAt(0).toUpperCase()}${i.slice(1)} operations`,li=i=>i.operations?.plans??[],To=(i,t)=>li(i).find(e=>ss(e)===t)??null;function Mr(i,t){let{values:e}=t.get(i.array);return n=>e[n]-1}var jm=.01;function rf(i,t,e,n){let s=Le(n.normal,n.direction),r=Math.acos(Math.min(1,Math.max(-1,It(e,n.normal))))*fn,o=Math.atan2(It(e,s),It(e,n.direction))*fn;return{tilt:r,rotation:ai(r<jm?t.get(i.lean).values[n.row]/100:o)}}function of(i){let t=li(i.meta);if(!t.length)return null;let e=[["verdict","Verdicts"]];for(let r of t)e.push([ss(r),t.length>1?vr(r):"Operations"]);let n=e.map(([r,o])=>re(o,()=>i.setMode(r),{title:"Verdicts or operations (o)"})),s=()=>e.forEach(([r],o)=>n[o].setAttribute("aria-pressed",String(i.mode===r)));return i.on("look",s),s(),Y("span",{class:"group",id:"show",role:"group","aria-label":"Show"},...n)}function af(i){let t=["verdict",...li(i.meta).map(ss)];i.setMode(t[(t.indexOf(i.mode)+1)%t.length]);let e=i.plan;i.say(e?vr(e):"Verdicts")}var Ao=class{constructor(t){this.app=t;for(let e of li(t.meta))for(let n of document.querySelectorAll(`#operations table[data-plan="${e.key}"] tr[data-operation]`)){let s=Number(n.dataset.operation),r=e.operations[s];r&&this.enliven(n,e,r,s)}t.on("operation",()=>this.mark()),this.mark()}app;rows=new Map;enliven(t,e,n,s){let{app:r}=this,o=t.nextElementSibling,l=o?.classList.contains("more")?[t,o]:[t];this.rows.set(n,l);let a=ns(t.querySelector("th")??t,()=>this.show(e,n));a.prepend(es(n.colour,n.pattern)," ");let c=()=>r.lightOperation(e,s),u=()=>r.lightOperation(null,-1);for(let h of l)h.addEventListener("pointerenter",c),h.addEventListener("pointerleave",u),h.addEventListener("click",f=>{f.target.closest("button")||this.show(e,n)});a.addEventListener("focus",c),a.addEventListener("blur",u)}mark(){for(let[t,e]of this.rows){let n=t===this.app.operation;for(let s of e)s.classList.toggle("shown",n);e[0].querySelector("button").setAttribute("aria-pressed",String(n))}}show(t,e){let{app:n}=this;n.mode!==ss(t)&&n.setMode(ss(t)),n.cutter.id!==e.cutter&&n.setCutter(e.cutter),n.select(e.sample),n.clip?.release(),this.face(),document.getElementById("frame")?.scrollIntoView({block:"nearest"}),n.say(e.text)}face(){let t=this.app.placed();if(!t)return;let{table:e}=this.app.stage,{turn:n,rise:s}=e.facing(t.axis),r=e.fitted(n,s),{up:o,right:l}=e.frame(r),a=Rn(t.tip,r.target),c=Math.max(...this.app.cutter.outline.flatMap(({points:f})=>f.map(([d])=>d))),[u,h]=[l,o].map(f=>1.06*(Math.abs(It(a,f))+c));e.fly({...r,half:Math.max(r.half,h,u/e.aspect)})}};var lf=["plain","hatch","dots","cross","bars","lines","back"],cf=i=>i.charAt(0).toUpperCase()+i.slice(1),Lc="#9a9a9a",be=(i,t)=>(i.words[t]??i.causes[t])?.name??t,Dc=["#9ddcc6","plain"];function Eo(i,t){let e=i.causes[t];return e?[e.colour,e.pattern]:[Dn(i,t==="free"?"interference_free":t),ff(t)]}var eg=[["convex","#E8B04A","plain"],["concave","#2F6DB0","plain"],["saddle","#7FC8A9","plain"]];function uf(i,t){let e=i.scalars.filter(n=>n.cutter===null||n.cutter===t);return[{key:"verdict",label:"Verdict"},...li(i).map(n=>({key:ss(n),label:vr(n)})),{key:"reason",label:"Reason"},...i.setups.length?[{key:"setup",label:"Setup that serves"}]:[],{key:"class",label:"Surface class"},...e.map(n=>({key:`scalar:${n.key}`,label:cf(n.label)}))]}function hf(i,t,e,n,s){let r=i.scalars.find(l=>`scalar:${l.key}`===n);if(r)return ag(t,e,r);if(n==="reason")return sg(i,e,s);if(n==="setup")return rg(i,e,s);if(n==="class")return og(i,e);let o=To(i,n);return o?ig(i,t,e,o,s):ng(i,e,s)}var Dn=(i,t)=>i.words[t]?.colour??Lc;function ff(i){return i==="inaccessible"?"hatch":i==="undecided"?"dots":"plain"}var Sr=(i,t)=>({colour:Dn(i,t),pattern:"plain",label:be(i,t)}),Uc=["interference_free","accessible","undecided","inaccessible","unjudged","inside_bodies"],df=i=>Uc.map(t=>({colour:Dn(i,t),pattern:ff(t),label:be(i,t)}));function ng(i,t,e){return br(i,"Verdict",df(i),t,n=>Uc.indexOf(t.verdict(e,n)))}function ig(i,t,e,n,s){let{operations:r}=n,o=Mr(n,t);return br(i,vr(n),[...r,...df(i)],e,l=>{let a=o(l);return a>=0?a:r.length+Uc.indexOf(e.verdict(s,l))})}function sg(i,t,e){let n=t.verdicts(e).values,s=t.reasons(e).values,r=i.reasons.map(c=>({colour:Eo(i,c)[0],pattern:"hatch",label:be(i,c)})),o=r.map(c=>({...c,pattern:"dots",label:`${c.label}, undecided`})),l=[{colour:"#d9e4dd",pattern:"plain",label:"reached"},Sr(i,"unjudged"),Sr(i,"inside_bodies")],a=r.length;return br(i,"Reason",[...r,...o,...l],t,c=>t.inside(c)?2*a+2:n[c]===255?2*a+1:s[c]===255?2*a:s[c]+(i.verdicts[String(n[c])]==="undecided"?a:0))}function rg(i,t,e){let n=i.setups.length,s=i.setups.map(({z:r},o)=>({colour:Ro(n>1?o/(n-1):0),pattern:"plain",label:`setup ${o+1}: ${r.map(a=>Number(a.toFixed(4))).join(", ")}`}));return s.push({colour:Dn(i,"inaccessible"),pattern:"hatch",label:"no setup"},Sr(i,"unjudged"),Sr(i,"inside_bodies")),br(i,"Setup that serves",s,t,r=>{let o=t.verdict(e,r);return o==="inside_bodies"?n+2:o==="unjudged"?n+1:t.setup(e,r)??n})}function og(i,t){let e=t.surfaceClass.values,n=eg.map(([s,r,o])=>({label:s,colour:r,pattern:o}));return n.push(Sr(i,"unjudged")),br(i,"Surface class",n,t,s=>Math.min(e[s],3))}function br(i,t,e,n,s){let{count:r}=n,o=new Uint8Array(4*r),l=e.map(p=>[...oi(p.colour),lf.indexOf(p.pattern)]),a=new Float64Array(e.length),c=new Uint8Array(e.length);for(let p=0;p<r;p++){let m=s(p);c[m]=1,a[m]+=n.area(p),o.set(l[m],4*p)}let u=a.reduce((p,m)=>p+m,0),h=e.findIndex(p=>p.label===be(i,"inside_bodies")),f=u-(a[h]??0),d=c.filter((p,m)=>p&&m!==h).length,g=(p,m)=>m?1:Math.min(Math.max(p,Number.MIN_VALUE),1-Number.EPSILON),y=e.map((p,m)=>({...p,share:m===h?g(a[m]/(u||1),!d):g(a[m]/(f||1),d===1)}));return{title:t,entries:y.filter((p,m)=>c[m]),ramp:null,bytes:o}}function ag(i,t,e){let n=i.get(e.array),s=(e.column??0)*n.rows,r=n.values.subarray(s,s+n.rows),[o,l]=lg(r),a=new Uint8Array(4*t.count),c=Array.from({length:256},(m,x)=>oi(Ro(x/255))),u=oi(Lc),h=l-o||1,[f,d,g]=[!1,!1,0],y=0;for(let m=0;m<t.count;m++){y+=t.area(m);let x=r[m];if(Number.isNaN(x)){g+=t.area(m),a.set(u,4*m),a[4*m+3]=lf.indexOf("cross");continue}let M=(x-o)/h;f||=M<-.001,d||=M>1.001,a.set(c[Math.round(255*Math.min(1,Math.max(0,M)))],4*m)}let p=g?[{colour:Lc,pattern:"cross",label:"not known",share:g/(y||1)}]:[];return{title:cf(e.label),entries:p,ramp:{low:o,high:l,unit:e.unit,below:f,above:d},bytes:a}}function lg(i){let t=Float32Array.from(i).filter(Number.isFinite).sort();if(!t.length)return[0,1];let e=n=>t[Math.round(n*(t.length-1))];return[e(.01),e(.99)]}function Ro(i){let t=.38+.54*i,e=(275-170*i)*Math.PI/180,n=.105+.02*i;return cg(t,n*Math.cos(e),n*Math.sin(e))}function cg(i,t,e){let n=(i+.3963377774*t+.2158037573*e)**3,s=(i-.1055613458*t-.0638541728*e)**3,r=(i-.0894841775*t-1.291485548*e)**3;return`#${[4.0767416621*n-3.3077115913*s+.2309699292*r,-1.2684380046*n+2.6097574011*s-.3413193965*r,-.0041960863*n-.7034186147*s+1.707614701*r].map(a=>{let c=Math.min(1,Math.max(0,a));return Math.round(255*(c<=.0031308?12.92*c:1.055*c**(1/2.4)-.055))}).map(a=>a.toString(16).padStart(2,"0")).join("")}`}function oi(i){let t=Number.parseInt(i.slice(1),16);return[t>>16&255,t>>8&255,t&255]}var Pi=(i,t)=>Math.abs(i.tilt-t.tilt)<.02&&bs(i.rotation,t.rotation)<.02,ci=class{constructor(t,e){this.meta=t;this.arrays=e;this.face=e.get("sample.face"),this.surfaceClass=e.get("sample.class"),this.count=this.face.rows}meta;arrays;count;face;surfaceClass;at(t){let e=this.point(t),n=this.normal(t),s=this.arrays.get("sample.direction").values[t]/32767*Math.PI,r=Ci(n),o=He(r,Math.cos(s),Le(n,r),Math.sin(s)),l=this.arrays.get("sample.curvature");return{row:t,point:e,normal:n,direction:o,curvature:[l.values[t],l.values[l.rows+t]],face:this.face.values[t]}}told(t){let{low:e,high:n}=this.meta.part,s=Math.max(...[0,1,2].map(o=>n[o]-e[o]))/65535,r=Math.min(20,Math.max(0,Math.floor(-Math.log10(s||1))));return this.point(t).map(o=>Number(o.toFixed(r)))}point(t){let{rows:e,values:n}=this.arrays.get("sample.point"),{low:s,high:r}=this.meta.part;return[0,1,2].map(o=>s[o]+(r[o]-s[o])*n[o*e+t]/65535)}normal(t){let{rows:e,values:n}=this.arrays.get("sample.normal");return wo(n[t]/32767,n[e+t]/32767)}area(t){let{values:e}=this.arrays.get("sample.area");return Number.isFinite(e[t])?e[t]:0}verdicts(t){return this.arrays.get(`verdict.${t}`)}reasons(t){return this.arrays.get(`reason.${t}`)}inside(t){return this.arrays.has("sample.inside")&&this.arrays.get("sample.inside").values[t]===1}setup(t,e){if(!this.arrays.has(`setup.${t}`))return 0;let n=this.arrays.get(`setup.${t}`).values[e];return n===255?null:n}verdict(t,e){return this.inside(e)?"inside_bodies":this.meta.verdicts[String(this.verdicts(t).values[e])]??"unjudged"}reason(t,e){let n=this.reasons(t).values[e];return n===255?null:this.meta.reasons[n]??null}posture(t,e){if(!this.arrays.has(`tilt.${t}`))return null;let n=this.arrays.get(`tilt.${t}`).values[e];return n===65535?null:{tilt:n/100,rotation:ai(this.arrays.get(`lean.${t}`).values[e]/100)}}static lean(t,e){let n=Le(t.normal,t.direction);return He(t.direction,Math.cos(e*Ne),n,Math.sin(e*Ne))}};var Co=1e-6,pf=.001;function Po(i,t){return i.modes.find(e=>t>=e.tilt_low_deg-Co&&t<=e.tilt_high_deg+Co)??null}function wr(i,t,e){let n=Po(i,e.tilt)??i.modes[i.modes.length-1],s=ci.lean(t,e.rotation),r=Math.cos(e.tilt*Ne),o=Math.sin(e.tilt*Ne),l=He(t.normal,r,s,o),a=He(s,r,t.normal,-o),c=ce(t.point,t.normal,n.radius+i.allowance_mm);return{tip:ce(ce(c,a,-n.offset),l,-n.height),axis:l}}function hg([i,t],e,n,s){let r=Math.cos(e),o=Math.sin(e),l=i*o*o+t*r*r;if(s>0){if(n===0)return s*i<=1+pf?[0,Math.PI]:null;let c=1-s*(i*r*r+t*o*o);if(c<=0)return null;l+=((i-t)*o*r)**2*s/c;let u=1-s*l;if(n<0){let h=n*l/u;return[0,u>=0||h>=1?Math.PI:Math.asin(h)]}if(u<=0)return l<=0?[0,Math.PI]:null;l/=u}let a=n*l;return a<=pf?[0,Math.PI]:a>1?null:[Math.asin(a),Math.PI-Math.asin(a)]}function mf(i,t,e){if(!Number.isFinite(t.curvature[0])||!Number.isFinite(t.curvature[1]))return!1;let n=Po(i,e.tilt);if(!n)return!1;let s=n.radius+i.allowance_mm,r=hg(t.curvature,e.rotation*Ne,n.offset,s);return!r||e.tilt*Ne<r[0]-Co||e.tilt*Ne>r[1]+Co}function gf(i,t,e,n,s){let r=ci.lean(i,t),[o,l]=[It(i.normal,e),It(r,e)],a=Math.hypot(o,l),c=Math.cos(n*Ne);if(a<=Math.abs(c))return c<=0?[s]:[];let u=Math.atan2(l,o)*fn,h=Math.acos(c/a)*fn,f=[];for(let d of[-360,0,360]){let g=Math.max(s[0],u+d-h),y=Math.min(s[1],u+d+h);g<=y&&f.push([g,y])}return f}function Io(i,t){let e=[],n=!1;return i.forEach((s,r)=>{let o=t(s,r);o&&!n?e.push([s,s]):o&&(e[e.length-1][1]=s),n=o}),e}function xf(i,t){return i.flatMap(([n,s])=>t.map(([r,o])=>[Math.max(n,r),Math.min(s,o)])).filter(([n,s])=>n<=s).sort((n,s)=>n[0]-s[0])}function yf(i,t){let e=fg(i.points,t),n=[];for(let a=0;a+1<e.length;a++){let[[c,u],[h,f]]=[e[a],e[a+1]];f-u<1e-9||c<=0&&h<=0||(c<0&&([c,u]=[0,u+(f-u)*-c/(h-c)]),h<0&&([h,f]=[0,u+(f-u)*c/(c-h)]),n.push(u,f,c,h))}let s=new Float64Array(n),[r,o,l]=[1/0,-1/0,0];for(let a=0;a<s.length;a+=4)r=Math.min(r,s[a]),o=Math.max(o,s[a+1]),l=Math.max(l,s[a+2],s[a+3]);return{part:i.part,cones:s,low:r,high:o,widest:l}}function fg(i,t){let e=i.filter((s,r)=>r===0||Math.hypot(s[0]-i[r-1][0],s[1]-i[r-1][1])>1e-9),n=e.slice(1).map(([s,r],o)=>{let[l,a]=[s-e[o][0],r-e[o][1]],c=Math.hypot(l,a);return[-a/c,l/c]});return e.map(([s,r],o)=>{let l=n[Math.max(0,o-1)],a=n[Math.min(n.length-1,o)];if(!l||!a)return[s,r];let c=t/Math.max(.2,1+l[0]*a[0]+l[1]*a[1]);return[s+c*(l[0]+a[0]),r+c*(l[1]+a[1])]})}var Fn=new Float64Array(8),On=new Float64Array(8),Un=new Float64Array(8),Fc=new Float64Array(8),Oc=new Float64Array(8),Bc=new Float64Array(8),dn={x:0,y:0,h:0,depth:0};function vf(i,t,e){let n=Math.min(t[2],t[5],t[8]),s=Math.max(t[2],t[5],t[8]);if(dn.depth=0,n>=i.high||s<=i.low)return!1;let{cones:r}=i;for(let o=0;o<r.length;o+=4)if(!(n>=r[o+1]||s<=r[o])&&(dg(r[o],r[o+1],r[o+2],r[o+3],t,n,s),dn.depth>0&&!e))return!0;return dn.depth>0}function dg(i,t,e,n,s,r,o){let l=(n-e)/(t-i),a=3;for(let h=0;h<3;h++)Fn[h]=s[3*h],On[h]=s[3*h+1],Un[h]=s[3*h+2];if(r<i&&(a=_f(a,i,1)),o>t&&a&&(a=_f(a,t,-1)),a<2)return;let c=0,u=0;for(let h=0;h<a;h++){let f=h+1===a?0:h+1,d=Fn[f]-Fn[h],g=On[f]-On[h],y=l*(Un[f]-Un[h]),p=e+l*(Un[h]-i),m=d*d+g*g-y*y,x=Fn[h]*d+On[h]*g-p*y,M=m>0?Math.min(1,Math.max(0,-x/m)):0;Mf(Fn[h]+M*d,On[h]+M*g,Un[h]+M*(Un[f]-Un[h]),p+M*y);let v=Fn[h]*g-On[h]*d;v>0?c++:v<0&&u++}c+u>0&&(c===0||u===0)&&pg(s,i,t,e,l)}function Mf(i,t,e,n){let s=n-Math.sqrt(i*i+t*t);s>dn.depth&&(dn.x=i,dn.y=t,dn.h=e,dn.depth=s)}function pg(i,t,e,n,s){let r=(i[3]-i[0])*(i[7]-i[1])-(i[6]-i[0])*(i[4]-i[1]);if(r===0)return;let o=(-i[0]*(i[7]-i[1])+(i[6]-i[0])*i[1])/r,l=(-(i[3]-i[0])*i[1]+i[0]*(i[4]-i[1]))/r,a=i[2]+o*(i[5]-i[2])+l*(i[8]-i[2]);a>=t&&a<=e&&Mf(0,0,a,n+s*(a-t))}function _f(i,t,e){let n=0;for(let s=0;s<i;s++){let r=s+1===i?0:s+1,o=e*(Un[s]-t),l=e*(Un[r]-t);if(o>=0&&(Fc[n]=Fn[s],Oc[n]=On[s],Bc[n++]=Un[s]),o>=0!=l>=0){let a=o/(o-l);Fc[n]=Fn[s]+a*(Fn[r]-Fn[s]),Oc[n]=On[s]+a*(On[r]-On[s]),Bc[n++]=t}}for(let s=0;s<n;s++)Fn[s]=Fc[s],On[s]=Oc[s],Un[s]=Bc[s];return n}var zc={state:"free",part:null,owner:null,point:null,depth:0},Lo=class{constructor(t,e){this.cutter=t;let n=e.overlooked_mm;this.spared=n,this.solids=t.outline.map(s=>yf(s,n-(s.part==="flutes"?t.allowance_mm:t.clearance_mm))),this.near=2*t.radius}cutter;solids;near;spared},No=class{constructor(t,e,n){this.drawn=t;this.machine=n;this.index=t.tree.geometry.index.array,this.ignored=e.faces.map(s=>s.ignored)}drawn;machine;index;corner=new Float64Array(9);ignored;last=new Map;look(t,e,n,s=!1){let r=wr(t.cutter,e,n);if(!this.machine.holds(r.axis))return{...zc,state:"axis_limit"};if(!Po(t.cutter,n.tilt))return{...zc,state:"no_contact"};let o=this.obstacles(t,e,r,s);return o.state==="rear_gouge"&&mf(t.cutter,e,n)?{...o,state:"local_gouge"}:o}obstacles(t,e,n,s){let r=null;for(let o of t.solids){let l=o.part==="flutes";for(let a of l?[!0,!1]:[!1]){let c=this.meets(o,n,s,a?{sample:e,within:t.near}:null);if(!c)continue;let u=a?"rear_gouge":l?"collision":o.part,h={...c,state:c.owner<0?"fixture":u};if(h.state!=="fixture")return h;r??=h}}return r??zc}meets(t,e,n,s){let{axis:r,tip:o}=e,l=Ci(r),a=Le(r,l),{position:c}=this.drawn,{index:u,corner:h,ignored:f}=this,{owner:d}=this.drawn,g=null,y=null,p=`${t.part}${s?"!":""}`,m=v=>{let S=d[u[3*v]];if(S>=0?f[S]:!this.drawn.there(S))return!1;for(let b=0;b<3;b++){let L=3*u[3*v+b],E=c[L]-o[0],C=c[L+1]-o[1],I=c[L+2]-o[2];h[3*b]=E*l[0]+C*l[1]+I*l[2],h[3*b+1]=E*a[0]+C*a[1]+I*a[2],h[3*b+2]=E*r[0]+C*r[1]+I*r[2]}if(!vf(t,h,n))return!1;let A=ce(ce(ce(o,l,dn.x),a,dn.y),r,dn.h);if(s){let b=Rn(A,s.sample.point);if(It(b,s.sample.normal)<=0||It(b,b)>s.within**2)return!1}let _={state:"collision",part:t.part,owner:S,point:A,depth:dn.depth};return S<0?((!y||y.depth<_.depth)&&(y=_),!1):((!g||g.depth<_.depth)&&(g=_),this.last.set(p,v),!n)},x=this.last.get(p);if(!n&&x!==void 0&&m(x))return g;let M=new Float64Array(3);return this.drawn.tree.shapecast({intersectsBounds:v=>{let{min:S,max:A}=v;M[0]=.5*(S.x+A.x)-o[0],M[1]=.5*(S.y+A.y)-o[1],M[2]=.5*(S.z+A.z)-o[2];let[_,b,L]=[.5*(A.x-S.x),.5*(A.y-S.y),.5*(A.z-S.z)],E=M[0]*r[0]+M[1]*r[1]+M[2]*r[2],C=_*Math.abs(r[0])+b*Math.abs(r[1])+L*Math.abs(r[2]);if(E-C>=t.high||E+C<=t.low)return!1;let I=M[0]**2+M[1]**2+M[2]**2-E*E,U=t.widest+Math.sqrt(_*_+b*b+L*L);if(I>=U*U)return!1;if(s){let P=s.sample.point,B=Math.max(S.x-P[0],0,P[0]-A.x),H=Math.max(S.y-P[1],0,P[1]-A.y),G=Math.max(S.z-P[2],0,P[2]-A.z);if(B*B+H*H+G*G>s.within**2)return!1}return!0},intersectsRange:(v,S)=>{for(let A=v;A<v+S;A++)if(m(A))return!0;return!1}}),g??y}};function Sf(i){let[t,e]=i.tilt_deg,n=[];for(let s=t;s<e;s+=1)n.push(s);return n.push(e),{rotations:i.rotation_deg,tilts:n,state:new Uint8Array(i.rotation_deg.length*n.length),done:0}}function bf(i,t,e,n){let s=i.done++,r=i.rotations[s];i.tilts.forEach((o,l)=>{let a=t.look(e,n,{tilt:o,rotation:r});i.state[s*i.tilts.length+l]=ts.indexOf(a.state)})}var wf=.1,Do=class{constructor(t){this.meta=t}meta;at=0;stand(t){this.at=t}get setup(){return this.meta.setups[this.at]??{z:this.meta.setup.z,kinematics:this.meta.kinematics}}get kinematics(){return this.setup.kinematics}positions(t){let e=({angles:s,within:r})=>(r.every(Boolean)?0:1e6)+s.reduce((o,l)=>o+Math.abs(l),0),n=this.kinematics?Ef(this.kinematics,t).sort((s,r)=>e(s)-e(r)):[];return n.filter((s,r)=>r===0||s.angles.some((o,l)=>Math.abs(o-n[0].angles[l])>1e-4))}get limited(){return this.meta.tilt_limit_deg!==null||this.meta.kinematics!==null}holds(t){let{tilt_limit_deg:e}=this.meta,{z:n,kinematics:s}=this.setup;return e!==null&&It(t,n)<Math.cos(e*Ne)-1e-9?!1:s===null||Af(s,t)}within(t,e,n){let{tilt_limit_deg:s,tilt_deg:r}=this.meta,{z:o,kinematics:l}=this.setup,a=t;if(s!==null&&(a=xf(a,gf(e,n,o,s,r))),l===null)return a;let c=ci.lean(e,n),u=h=>Af(l,He(e.normal,Math.cos(h*Ne),c,Math.sin(h*Ne)));return a.flatMap(([h,f])=>Io(mg(h,f),u))}};function mg(i,t){let e=Math.max(1,Math.ceil((t-i)/wf-1e-9));return Array.from({length:e+1},(n,s)=>s===e?t:i+s*wf)}var Af=(i,t)=>Ef(i,t).some(({within:e})=>e.every(Boolean));function Ef({direction:i,limit_deg:t,tool:e},n){if(i.length===0)return Ss(Le(n,e))<=1e-6&&It(n,e)>0?[Vc([],[])]:[];let[s,r]=i,o=It(s,n);if(i.length===1)return Math.abs(o-It(s,e))<=1e-6?[Vc([Tf(s,e,n).angle],t)]:[];let l=It(r,e),a=Rn(e,Ei(r,l)),c=Le(r,e),[u,h]=[It(s,a),It(s,c)],f=(o-l*It(s,r))/Math.hypot(u,h);if(!(Math.abs(f)<=1+1e-12))return[];let d=Math.acos(Math.min(1,Math.max(-1,f))),g=Math.atan2(h,u);return[g+d,g-d].map(y=>{let p=ce(ce(Ei(r,l),a,Math.cos(y)),c,Math.sin(y)),m=Tf(s,p,n),x=Vc([m.angle,y],t);if(m.size>1e-6**4)return x;let[M,v]=t[0];return{angles:[Math.min(Math.max(0,M??-1/0),v??1/0),x.angles[1]],within:[!0,x.within[1]],free:!0}})}function Vc(i,t){let e=i.map((n,s)=>gg(n,t[s]));return{angles:e.map((n,s)=>(n??i[s])*fn),within:e.map(n=>n!==null),free:!1}}function Tf(i,t,e){let n=It(i,Le(t,e)),s=It(t,e)-It(i,t)*It(i,e);return{angle:Math.atan2(n,s),size:n*n+s*s}}function gg(i,[t,e]){let n=2*Math.PI,s=t===null?-1/0:Math.ceil((t*Ne-1e-9-i)/n),r=e===null?1/0:Math.floor((e*Ne+1e-9-i)/n);return s<=r?i+n*Math.min(Math.max(0,s),r):null}var Uo=class{constructor(t,e,n,s,r,o,l,a,c){this.meta=t;this.arrays=e;this.samples=n;this.drawn=s;this.stage=r;this.part=o;this.tool=l;this.picker=a;this.say=c;this.cutter=this.cutterOf(t.shown),this.machine=new Do(t)}meta;arrays;samples;drawn;stage;part;tool;picker;say;cutter;machine;mode="verdict";sample=null;spot=null;posture=null;met=null;state=null;judge=(t,e)=>({state:e.state,certified:!1});hot=null;toolShown=!0;clip=null;outline=null;note="";madeProbe=null;liveTools=new Map;told=new Map;on(t,e){this.told.set(t,[...this.told.get(t)??[],e])}emit(t){for(let e of this.told.get(t)??[])e()}cutterOf(t){return this.meta.cutters.find(e=>e.id===t)??this.meta.cutters[0]}get probe(){return this.madeProbe??=new No(this.drawn,this.meta,this.machine),this.madeProbe}liveTool(t=this.cutter){let e=this.liveTools.get(t.id);return e||(e=new Lo(t,this.meta),this.liveTools.set(t.id,e)),e}setCutter(t){this.cutter=this.cutterOf(t),this.spot=null,this.emit("cutter"),this.repaint(),this.sample&&this.select(this.sample.row),this.say(`Cutter ${this.cutter.name||this.cutter.id} is shown`)}setMode(t){let e=this.plan;this.mode=t,this.repaint(),this.sample&&this.plan!==e&&this.select(this.sample.row,this.spot)}repaint(){let t=hf(this.meta,this.arrays,this.samples,this.mode,this.cutter.id);this.part.paint(t,this.standOut),this.look=t,this.emit("look"),this.stage.request()}look=null;get plan(){return To(this.meta,this.mode)}operationAt(t){let{plan:e}=this;return e?.operations[Mr(e,this.arrays)(t)]??null}get operation(){let t=this.sample&&this.operationAt(this.sample.row);return t?.cutter===this.cutter.id?t:null}standOut=null;lightOperation(t,e){let n=t&&Mr(t,this.arrays);this.standOut=n&&(s=>n(s)===e),this.look&&this.part.paint(this.look,this.standOut),this.stage.request()}placed(){return this.sample&&this.posture&&wr(this.cutter,this.sample,this.posture)}select(t,e=null){this.sample=t===null?null:this.samples.at(t),this.spot=t===null?null:e??this.spotOf(t),this.posture=null,this.met=null,this.stand(this.operation?.setup??(t===null?0:this.samples.setup(this.cutter.id,t)??0)),this.emit("sample"),this.emit("operation"),e&&this.emit("spot"),this.setPosture(t===null?null:this.startPosture(t))}stand(t){this.machine.stand(t),this.drawn.setup!==t&&(this.drawn.setup=t,this.part.stand(),this.clip?.stand(),this.stage.request())}spotOf(t){return this.meta.spots.find(e=>e.sample===t&&e.cutter===this.cutter.id)??null}plannedPosture(){let t=this.operation?.axis;return t&&this.plan&&this.sample?rf(this.plan,this.arrays,t,this.sample):null}startPosture(t){let e=this.plannedPosture();if(e)return e;let n=this.samples.posture(this.cutter.id,t);return n||this.witness()}witness(){let{tilt_deg:t=null,lean_deg:e=null}=this.spot??{};return t===null||e===null?null:{tilt:t,rotation:ai(e)}}setPosture(t){this.posture=t;let{sample:e}=this;this.met=this.state=null,e&&t&&(this.tool.show(this.cutter,wr(this.cutter,e,t)),this.met=this.probe.look(this.liveTool(),e,t,!0),this.state=this.judge(t,this.met),this.state.state==="free"&&(this.met=null)),(!e||!t||!this.toolShown)&&this.tool.hide(),this.emit("posture"),this.light()}inTheWay(){if(this.atWitness()){let t=this.spot,e=this.drawn.ownerOf(t.obstacle_face);if(t.obstacle_point||e!==null)return{point:t.obstacle_point,owner:e}}return this.met&&this.met.owner!==null?{point:this.met.point,owner:this.met.owner}:null}faceShown(){let t=this.meta.faces.findIndex(e=>e.number===this.sample?.face);return t<0?null:t}atWitness(){let t=this.witness();return this.posture!==null&&t!==null&&Pi(this.posture,t)}hover(t,e=!1){t===this.hot&&e===this.lit||(this.hot=t,this.emit("hot"),(this.lit!==e||e)&&(this.lit=e,this.light()))}lit=!1;light(){let t=this.inTheWay()?.owner??null,e=t!==null&&this.sample!==null&&this.meta.faces[t]?.number===this.sample.face;this.part.light(this.lit?this.hot:null,e?null:t),this.outline?.show(t),this.stage.request()}showTool(t){this.toolShown=t,this.setPosture(this.posture)}};var nd=0,yu=1,id=2;var $r=1,sd=2,Zs=3,Vn=0,qe=1,ye=2,hs=0,Js=1,vu=2,Mu=3,Su=4,rd=5;var fs=100,od=101,ad=102,ld=103,cd=104,ud=200,hd=201,fd=202,dd=203,bu=204,wu=205,pd=206,md=207,gd=208,xd=209,_d=210,yd=211,vd=212,Md=213,Sd=214,aa=0,la=1,ca=2,ks=3,ua=4,ha=5,Vs=6,fa=7,Au=0,bd=1,wd=2,Qn=0,Tu=1,Eu=2,Ru=3,Cu=4,Pu=5,Iu=6,Lu=7;var Nu=300,ds=301,Ks=302,ka=303,Va=304,da=1e3,Zn=1001,pa=1002,Ce=1003,Ad=1004;var Zr=1005;var rn=1006,Ga=1007;var vi=1008;var ln=1009,Du=1010,Uu=1011,Qs=1012,Ha=1013,Gn=1014,Hn=1015,Wn=1016,Wa=1017,Xa=1018,ps=1020,Fu=35902,Ou=35899,Bu=1021,zu=1022,Mn=1023,xi=1026,Mi=1027,ku=1028,qa=1029,Hi=1030,Ya=1031;var $a=1033,Jr=33776,Kr=33777,Qr=33778,jr=33779,Za=35840,Ja=35841,Ka=35842,Qa=35843,ja=36196,tl=37492,el=37496,nl=37488,il=37489,to=37490,sl=37491,rl=37808,ol=37809,al=37810,ll=37811,cl=37812,ul=37813,hl=37814,fl=37815,dl=37816,pl=37817,ml=37818,gl=37819,xl=37820,_l=37821,yl=36492,vl=36494,Ml=36495,Sl=36283,bl=36284,eo=36285,wl=36286;var Ir=2300,ma=2301,ra=2302,fu=2303,du=2400,pu=2401,mu=2402;var Td=3200;var Vu=0,Ed=1,Si="",gn="srgb",Lr="srgb-linear",Nr="linear",ne="srgb";var Gu=0,oa=7680;var no=5386;var Hu=517;var Al=519,Rd=512,Cd=513,Pd=514,Wu=515,Id=516,Ld=517,Xu=518,qu=519,Nd=35044;var bi="300 es",Pn=2e3,Dr=2001;function xg(i){for(let t=i.length-1;t>=0;--t)if(i[t]>=65535)return!0;return!1}function _g(i){return ArrayBuffer.isView(i)&&!(i instanceof DataView)}function Ur(i){return document.createElementNS("http://www.w3.org/1999/xhtml",i)}function Dd(){let i=Ur("canvas");return i.style.display="block",i}var Rf={},Gs=null;function Yu(...i){let t="THREE."+i.shift();Gs?Gs("log",t,...i):console.log(t,...i)}function Ud(i){let t=i[0];if(typeof t=="string"&&t.startsWith("TSL:")){let e=i[1];e&&e.isStackTrace?i[0]+=" "+e.getLocation():i[1]='Stack trace not available. Enable "THREE.Node.captureStackTrace" to capture stack traces.'}return i}function Rt(...i){i=Ud(i);let t="THREE."+i.shift();if(Gs)Gs("warn",t,...i);else{let e=i[0];e&&e.isStackTrace?console.warn(e.getError(t)):console.warn(t,...i)}}function Lt(...i){i=Ud(i);let t="THREE."+i.shift();if(Gs)Gs("error",t,...i);else{let e=i[0];e&&e.isStackTrace?console.error(e.getError(t)):console.error(t,...i)}}function Pr(...i){let t=i.join(" ");t in Rf||(Rf[t]=!0,Rt(...i))}function Fd(i,t,e){return new Promise(function(n,s){function r(){switch(i.clientWaitSync(t,i.SYNC_FLUSH_COMMANDS_BIT,0)){case i.WAIT_FAILED:s();break;case i.TIMEOUT_EXPIRED:setTimeout(r,e);break;default:n()}}setTimeout(r,e)})}var Od={[aa]:aa,[ca]:Vs,[ua]:ua,[ks]:ha,[la]:la,[Vs]:ca,[fa]:fa,[ha]:ks},Jn=class{addEventListener(t,e){this._listeners===void 0&&(this._listeners={});let n=this._listeners;n[t]===void 0&&(n[t]=[]),n[t].indexOf(e)===-1&&n[t].push(e)}hasEventListener(t,e){let n=this._listeners;return n===void 0?!1:n[t]!==void 0&&n[t].indexOf(e)!==-1}removeEventListener(t,e){let n=this._listeners;if(n===void 0)return;let s=n[t];if(s!==void 0){let r=s.indexOf(e);r!==-1&&s.splice(r,1)}}dispatchEvent(t){let e=this._listeners;if(e===void 0)return;let n=e[t.type];if(n!==void 0){t.target=this;let s=n.slice(0);for(let r=0,o=s.length;r<o;r++)s[r].call(this,t);t.target=null}}},Ke=["00","01","02","03","04","05","06","07","08","09","0a","0b","0c","0d","0e","0f","10","11","12","13","14","15","16","17","18","19","1a","1b","1c","1d","1e","1f","20","21","22","23","24","25","26","27","28","29","2a","2b","2c","2d","2e","2f","30","31","32","33","34","35","36","37","38","39","3a","3b","3c","3d","3e","3f","40","41","42","43","44","45","46","47","48","49","4a","4b","4c","4d","4e","4f","50","51","52","53","54","55","56","57","58","59","5a","5b","5c","5d","5e","5f","60","61","62","63","64","65","66","67","68","69","6a","6b","6c","6d","6e","6f","70","71","72","73","74","75","76","77","78","79","7a","7b","7c","7d","7e","7f","80","81","82","83","84","85","86","87","88","89","8a","8b","8c","8d","8e","8f","90","91","92","93","94","95","96","97","98","99","9a","9b","9c","9d","9e","9f","a0","a1","a2","a3","a4","a5","a6","a7","a8","a9","aa","ab","ac","ad","ae","af","b0","b1","b2","b3","b4","b5","b6","b7","b8","b9","ba","bb","bc","bd","be","bf","c0","c1","c2","c3","c4","c5","c6","c7","c8","c9","ca","cb","cc","cd","ce","cf","d0","d1","d2","d3","d4","d5","d6","d7","d8","d9","da","db","dc","dd","de","df","e0","e1","e2","e3","e4","e5","e6","e7","e8","e9","ea","eb","ec","ed","ee","ef","f0","f1","f2","f3","f4","f5","f6","f7","f8","f9","fa","fb","fc","fd","fe","ff"];var Hc=Math.PI/180,ga=180/Math.PI;function io(){let i=Math.random()*4294967295|0,t=Math.random()*4294967295|0,e=Math.random()*4294967295|0,n=Math.random()*4294967295|0;return(Ke[i&255]+Ke[i>>8&255]+Ke[i>>16&255]+Ke[i>>24&255]+"-"+Ke[t&255]+Ke[t>>8&255]+"-"+Ke[t>>16&15|64]+Ke[t>>24&255]+"-"+Ke[e&63|128]+Ke[e>>8&255]+"-"+Ke[e>>16&255]+Ke[e>>24&255]+Ke[n&255]+Ke[n>>8&255]+Ke[n>>16&255]+Ke[n>>24&255]).toLowerCase()}function Bt(i,t,e){return Math.max(t,Math.min(e,i))}function yg(i,t){return(i%t+t)%t}function Wc(i,t,e){return(1-e)*i+e*t}function Bd(i){return Math.pow(2,Math.floor(Math.log(i)/Math.LN2))}function $u(i){switch(i.constructor){case Uint32Array:return 4294967295;case Uint16Array:return 65535;case Uint8Array:case Uint8ClampedArray:return 255;case Int32Array:return 2147483647;case Int16Array:return 32767;case Int8Array:return 127;default:return}}function vg(i,t){if(t.constructor===Float32Array)return i;let e=$u(t);if(e===void 0)throw new Error("THREE.MathUtils: Invalid component type.");return Math.max(i/e,-1)}function Mg(i,t){if(t.constructor===Float32Array)return i;let e=$u(t);if(e===void 0)throw new Error("THREE.MathUtils: Invalid component type.");return Math.round(i*e)}var Et=class{static{this.prototype.isVector2=!0}constructor(t=0,e=0){this.x=t,this.y=e}get width(){return this.x}set width(t){this.x=t}get height(){return this.y}set height(t){this.y=t}set(t,e){return this.x=t,this.y=e,this}setScalar(t){return this.x=t,this.y=t,this}setX(t){return this.x=t,this}setY(t){return this.y=t,this}setComponent(t,e){switch(t){case 0:this.x=e;break;case 1:this.y=e;break;default:throw new Error("THREE.Vector2: index is out of range: "+t)}return this}getComponent(t){switch(t){case 0:return this.x;case 1:return this.y;default:throw new Error("THREE.Vector2: index is out of range: "+t)}}clone(){return new this.constructor(this.x,this.y)}copy(t){return this.x=t.x,this.y=t.y,this}add(t){return this.x+=t.x,this.y+=t.y,this}addScalar(t){return this.x+=t,this.y+=t,this}addVectors(t,e){return this.x=t.x+e.x,this.y=t.y+e.y,this}addScaledVector(t,e){return this.x+=t.x*e,this.y+=t.y*e,this}sub(t){return this.x-=t.x,this.y-=t.y,this}subScalar(t){return this.x-=t,this.y-=t,this}subVectors(t,e){return this.x=t.x-e.x,this.y=t.y-e.y,this}multiply(t){return this.x*=t.x,this.y*=t.y,this}multiplyScalar(t){return this.x*=t,this.y*=t,this}divide(t){return this.x/=t.x,this.y/=t.y,this}divideScalar(t){return this.multiplyScalar(1/t)}applyMatrix3(t){let e=this.x,n=this.y,s=t.elements;return this.x=s[0]*e+s[3]*n+s[6],this.y=s[1]*e+s[4]*n+s[7],this}min(t){return this.x=Math.min(this.x,t.x),this.y=Math.min(this.y,t.y),this}max(t){return this.x=Math.max(this.x,t.x),this.y=Math.max(this.y,t.y),this}clamp(t,e){return this.x=Bt(this.x,t.x,e.x),this.y=Bt(this.y,t.y,e.y),this}clampScalar(t,e){return this.x=Bt(this.x,t,e),this.y=Bt(this.y,t,e),this}clampLength(t,e){let n=this.length();return this.divideScalar(n||1).multiplyScalar(Bt(n,t,e))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this}negate(){return this.x=-this.x,this.y=-this.y,this}dot(t){return this.x*t.x+this.y*t.y}cross(t){return this.x*t.y-this.y*t.x}lengthSq(){return this.x*this.x+this.y*this.y}length(){return Math.sqrt(this.x*this.x+this.y*this.y)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)}normalize(){return this.divideScalar(this.length()||1)}angle(){return Math.atan2(-this.y,-this.x)+Math.PI}angleTo(t){let e=Math.sqrt(this.lengthSq()*t.lengthSq());if(e===0)return Math.PI/2;let n=this.dot(t)/e;return Math.acos(Bt(n,-1,1))}distanceTo(t){return Math.sqrt(this.distanceToSquared(t))}distanceToSquared(t){let e=this.x-t.x,n=this.y-t.y;return e*e+n*n}manhattanDistanceTo(t){return Math.abs(this.x-t.x)+Math.abs(this.y-t.y)}setLength(t){return this.normalize().multiplyScalar(t)}lerp(t,e){return this.x+=(t.x-this.x)*e,this.y+=(t.y-this.y)*e,this}lerpVectors(t,e,n){return this.x=t.x+(e.x-t.x)*n,this.y=t.y+(e.y-t.y)*n,this}equals(t){return t.x===this.x&&t.y===this.y}fromArray(t,e=0){return this.x=t[e],this.y=t[e+1],this}toArray(t=[],e=0){return t[e]=this.x,t[e+1]=this.y,t}fromBufferAttribute(t,e){return this.x=t.getX(e),this.y=t.getY(e),this}rotateAround(t,e){let n=Math.cos(e),s=Math.sin(e),r=this.x-t.x,o=this.y-t.y;return this.x=r*n-o*s+t.x,this.y=r*s+o*n+t.y,this}random(){return this.x=Math.random(),this.y=Math.random(),this}*[Symbol.iterator](){yield this.x,yield this.y}},Kn=class{constructor(t=0,e=0,n=0,s=1){this.isQuaternion=!0,this._x=t,this._y=e,this._z=n,this._w=s}static slerpFlat(t,e,n,s,r,o,l){let a=n[s+0],c=n[s+1],u=n[s+2],h=n[s+3],f=r[o+0],d=r[o+1],g=r[o+2],y=r[o+3];if(h!==y||a!==f||c!==d||u!==g){let p=a*f+c*d+u*g+h*y;p<0&&(f=-f,d=-d,g=-g,y=-y,p=-p);let m=1-l;if(p<.9995){let x=Math.acos(p),M=Math.sin(x);m=Math.sin(m*x)/M,l=Math.sin(l*x)/M,a=a*m+f*l,c=c*m+d*l,u=u*m+g*l,h=h*m+y*l}else{a=a*m+f*l,c=c*m+d*l,u=u*m+g*l,h=h*m+y*l;let x=1/Math.sqrt(a*a+c*c+u*u+h*h);a*=x,c*=x,u*=x,h*=x}}t[e]=a,t[e+1]=c,t[e+2]=u,t[e+3]=h}static multiplyQuaternionsFlat(t,e,n,s,r,o){let l=n[s],a=n[s+1],c=n[s+2],u=n[s+3],h=r[o],f=r[o+1],d=r[o+2],g=r[o+3];return t[e]=l*g+u*h+a*d-c*f,t[e+1]=a*g+u*f+c*h-l*d,t[e+2]=c*g+u*d+l*f-a*h,t[e+3]=u*g-l*h-a*f-c*d,t}get x(){return this._x}set x(t){this._x=t,this._onChangeCallback()}get y(){return this._y}set y(t){this._y=t,this._onChangeCallback()}get z(){return this._z}set z(t){this._z=t,this._onChangeCallback()}get w(){return this._w}set w(t){this._w=t,this._onChangeCallback()}set(t,e,n,s){return this._x=t,this._y=e,this._z=n,this._w=s,this._onChangeCallback(),this}clone(){return new this.constructor(this._x,this._y,this._z,this._w)}copy(t){return this._x=t.x,this._y=t.y,this._z=t.z,this._w=t.w,this._onChangeCallback(),this}setFromEuler(t,e=!0){let n=t._x,s=t._y,r=t._z,o=t._order,l=Math.cos,a=Math.sin,c=l(n/2),u=l(s/2),h=l(r/2),f=a(n/2),d=a(s/2),g=a(r/2);switch(o){case"XYZ":this._x=f*u*h+c*d*g,this._y=c*d*h-f*u*g,this._z=c*u*g+f*d*h,this._w=c*u*h-f*d*g;break;case"YXZ":this._x=f*u*h+c*d*g,this._y=c*d*h-f*u*g,this._z=c*u*g-f*d*h,this._w=c*u*h+f*d*g;break;case"ZXY":this._x=f*u*h-c*d*g,this._y=c*d*h+f*u*g,this._z=c*u*g+f*d*h,this._w=c*u*h-f*d*g;break;case"ZYX":this._x=f*u*h-c*d*g,this._y=c*d*h+f*u*g,this._z=c*u*g-f*d*h,this._w=c*u*h+f*d*g;break;case"YZX":this._x=f*u*h+c*d*g,this._y=c*d*h+f*u*g,this._z=c*u*g-f*d*h,this._w=c*u*h-f*d*g;break;case"XZY":this._x=f*u*h-c*d*g,this._y=c*d*h-f*u*g,this._z=c*u*g+f*d*h,this._w=c*u*h+f*d*g;break;default:Rt("Quaternion: .setFromEuler() encountered an unknown order: "+o)}return e===!0&&this._onChangeCallback(),this}setFromAxisAngle(t,e){let n=e/2,s=Math.sin(n);return this._x=t.x*s,this._y=t.y*s,this._z=t.z*s,this._w=Math.cos(n),this._onChangeCallback(),this}setFromRotationMatrix(t){let e=t.elements,n=e[0],s=e[4],r=e[8],o=e[1],l=e[5],a=e[9],c=e[2],u=e[6],h=e[10],f=n+l+h;if(f>0){let d=.5/Math.sqrt(f+1);this._w=.25/d,this._x=(u-a)*d,this._y=(r-c)*d,this._z=(o-s)*d}else if(n>l&&n>h){let d=2*Math.sqrt(1+n-l-h);this._w=(u-a)/d,this._x=.25*d,this._y=(s+o)/d,this._z=(r+c)/d}else if(l>h){let d=2*Math.sqrt(1+l-n-h);this._w=(r-c)/d,this._x=(s+o)/d,this._y=.25*d,this._z=(a+u)/d}else{let d=2*Math.sqrt(1+h-n-l);this._w=(o-s)/d,this._x=(r+c)/d,this._y=(a+u)/d,this._z=.25*d}return this._onChangeCallback(),this}setFromUnitVectors(t,e){let n=t.dot(e)+1;return n<1e-8?(n=0,Math.abs(t.x)>Math.abs(t.z)?(this._x=-t.y,this._y=t.x,this._z=0,this._w=n):(this._x=0,this._y=-t.z,this._z=t.y,this._w=n)):(this._x=t.y*e.z-t.z*e.y,this._y=t.z*e.x-t.x*e.z,this._z=t.x*e.y-t.y*e.x,this._w=n),this.normalize()}angleTo(t){return 2*Math.acos(Math.abs(Bt(this.dot(t),-1,1)))}rotateTowards(t,e){let n=this.angleTo(t);if(n===0)return this;let s=Math.min(1,e/n);return this.slerp(t,s),this}identity(){return this.set(0,0,0,1)}invert(){return this.conjugate()}conjugate(){return this._x*=-1,this._y*=-1,this._z*=-1,this._onChangeCallback(),this}dot(t){return this._x*t._x+this._y*t._y+this._z*t._z+this._w*t._w}lengthSq(){return this._x*this._x+this._y*this._y+this._z*this._z+this._w*this._w}length(){return Math.sqrt(this._x*this._x+this._y*this._y+this._z*this._z+this._w*this._w)}normalize(){let t=this.length();return t===0?(this._x=0,this._y=0,this._z=0,this._w=1):(t=1/t,this._x=this._x*t,this._y=this._y*t,this._z=this._z*t,this._w=this._w*t),this._onChangeCallback(),this}multiply(t){return this.multiplyQuaternions(this,t)}premultiply(t){return this.multiplyQuaternions(t,this)}multiplyQuaternions(t,e){let n=t._x,s=t._y,r=t._z,o=t._w,l=e._x,a=e._y,c=e._z,u=e._w;return this._x=n*u+o*l+s*c-r*a,this._y=s*u+o*a+r*l-n*c,this._z=r*u+o*c+n*a-s*l,this._w=o*u-n*l-s*a-r*c,this._onChangeCallback(),this}slerp(t,e){let n=t._x,s=t._y,r=t._z,o=t._w,l=this.dot(t);l<0&&(n=-n,s=-s,r=-r,o=-o,l=-l);let a=1-e;if(l<.9995){let c=Math.acos(l),u=Math.sin(c);a=Math.sin(a*c)/u,e=Math.sin(e*c)/u,this._x=this._x*a+n*e,this._y=this._y*a+s*e,this._z=this._z*a+r*e,this._w=this._w*a+o*e,this._onChangeCallback()}else this._x=this._x*a+n*e,this._y=this._y*a+s*e,this._z=this._z*a+r*e,this._w=this._w*a+o*e,this.normalize();return this}slerpQuaternions(t,e,n){return this.copy(t).slerp(e,n)}random(){let t=2*Math.PI*Math.random(),e=2*Math.PI*Math.random(),n=Math.random(),s=Math.sqrt(1-n),r=Math.sqrt(n);return this.set(s*Math.sin(t),s*Math.cos(t),r*Math.sin(e),r*Math.cos(e))}equals(t){return t._x===this._x&&t._y===this._y&&t._z===this._z&&t._w===this._w}fromArray(t,e=0){return this._x=t[e],this._y=t[e+1],this._z=t[e+2],this._w=t[e+3],this._onChangeCallback(),this}toArray(t=[],e=0){return t[e]=this._x,t[e+1]=this._y,t[e+2]=this._z,t[e+3]=this._w,t}fromBufferAttribute(t,e){return this._x=t.getX(e),this._y=t.getY(e),this._z=t.getZ(e),this._w=t.getW(e),this._onChangeCallback(),this}toJSON(){return this.toArray()}_onChange(t){return this._onChangeCallback=t,this}_onChangeCallback(){}*[Symbol.iterator](){yield this._x,yield this._y,yield this._z,yield this._w}},N=class{static{this.prototype.isVector3=!0}constructor(t=0,e=0,n=0){this.x=t,this.y=e,this.z=n}set(t,e,n){return n===void 0&&(n=this.z),this.x=t,this.y=e,this.z=n,this}setScalar(t){return this.x=t,this.y=t,this.z=t,this}setX(t){return this.x=t,this}setY(t){return this.y=t,this}setZ(t){return this.z=t,this}setComponent(t,e){switch(t){case 0:this.x=e;break;case 1:this.y=e;break;case 2:this.z=e;break;default:throw new Error("THREE.Vector3: index is out of range: "+t)}return this}getComponent(t){switch(t){case 0:return this.x;case 1:return this.y;case 2:return this.z;default:throw new Error("THREE.Vector3: index is out of range: "+t)}}clone(){return new this.constructor(this.x,this.y,this.z)}copy(t){return this.x=t.x,this.y=t.y,this.z=t.z,this}add(t){return this.x+=t.x,this.y+=t.y,this.z+=t.z,this}addScalar(t){return this.x+=t,this.y+=t,this.z+=t,this}addVectors(t,e){return this.x=t.x+e.x,this.y=t.y+e.y,this.z=t.z+e.z,this}addScaledVector(t,e){return this.x+=t.x*e,this.y+=t.y*e,this.z+=t.z*e,this}sub(t){return this.x-=t.x,this.y-=t.y,this.z-=t.z,this}subScalar(t){return this.x-=t,this.y-=t,this.z-=t,this}subVectors(t,e){return this.x=t.x-e.x,this.y=t.y-e.y,this.z=t.z-e.z,this}multiply(t){return this.x*=t.x,this.y*=t.y,this.z*=t.z,this}multiplyScalar(t){return this.x*=t,this.y*=t,this.z*=t,this}multiplyVectors(t,e){return this.x=t.x*e.x,this.y=t.y*e.y,this.z=t.z*e.z,this}applyEuler(t){return this.applyQuaternion(Cf.setFromEuler(t))}applyAxisAngle(t,e){return this.applyQuaternion(Cf.setFromAxisAngle(t,e))}applyMatrix3(t){let e=this.x,n=this.y,s=this.z,r=t.elements;return this.x=r[0]*e+r[3]*n+r[6]*s,this.y=r[1]*e+r[4]*n+r[7]*s,this.z=r[2]*e+r[5]*n+r[8]*s,this}applyNormalMatrix(t){return this.applyMatrix3(t).normalize()}applyMatrix4(t){let e=this.x,n=this.y,s=this.z,r=t.elements,o=1/(r[3]*e+r[7]*n+r[11]*s+r[15]);return this.x=(r[0]*e+r[4]*n+r[8]*s+r[12])*o,this.y=(r[1]*e+r[5]*n+r[9]*s+r[13])*o,this.z=(r[2]*e+r[6]*n+r[10]*s+r[14])*o,this}applyQuaternion(t){let e=this.x,n=this.y,s=this.z,r=t.x,o=t.y,l=t.z,a=t.w,c=2*(o*s-l*n),u=2*(l*e-r*s),h=2*(r*n-o*e);return this.x=e+a*c+o*h-l*u,this.y=n+a*u+l*c-r*h,this.z=s+a*h+r*u-o*c,this}project(t){return this.applyMatrix4(t.matrixWorldInverse).applyMatrix4(t.projectionMatrix)}unproject(t){return this.applyMatrix4(t.projectionMatrixInverse).applyMatrix4(t.matrixWorld)}transformDirection(t){let e=this.x,n=this.y,s=this.z,r=t.elements;return this.x=r[0]*e+r[4]*n+r[8]*s,this.y=r[1]*e+r[5]*n+r[9]*s,this.z=r[2]*e+r[6]*n+r[10]*s,this.normalize()}divide(t){return this.x/=t.x,this.y/=t.y,this.z/=t.z,this}divideScalar(t){return this.multiplyScalar(1/t)}min(t){return this.x=Math.min(this.x,t.x),this.y=Math.min(this.y,t.y),this.z=Math.min(this.z,t.z),this}max(t){return this.x=Math.max(this.x,t.x),this.y=Math.max(this.y,t.y),this.z=Math.max(this.z,t.z),this}clamp(t,e){return this.x=Bt(this.x,t.x,e.x),this.y=Bt(this.y,t.y,e.y),this.z=Bt(this.z,t.z,e.z),this}clampScalar(t,e){return this.x=Bt(this.x,t,e),this.y=Bt(this.y,t,e),this.z=Bt(this.z,t,e),this}clampLength(t,e){let n=this.length();return this.divideScalar(n||1).multiplyScalar(Bt(n,t,e))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this.z=Math.floor(this.z),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this.z=Math.ceil(this.z),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this.z=Math.round(this.z),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this.z=Math.trunc(this.z),this}negate(){return this.x=-this.x,this.y=-this.y,this.z=-this.z,this}dot(t){return this.x*t.x+this.y*t.y+this.z*t.z}lengthSq(){return this.x*this.x+this.y*this.y+this.z*this.z}length(){return Math.sqrt(this.x*this.x+this.y*this.y+this.z*this.z)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)+Math.abs(this.z)}normalize(){return this.divideScalar(this.length()||1)}setLength(t){return this.normalize().multiplyScalar(t)}lerp(t,e){return this.x+=(t.x-this.x)*e,this.y+=(t.y-this.y)*e,this.z+=(t.z-this.z)*e,this}lerpVectors(t,e,n){return this.x=t.x+(e.x-t.x)*n,this.y=t.y+(e.y-t.y)*n,this.z=t.z+(e.z-t.z)*n,this}cross(t){return this.crossVectors(this,t)}crossVectors(t,e){let n=t.x,s=t.y,r=t.z,o=e.x,l=e.y,a=e.z;return this.x=s*a-r*l,this.y=r*o-n*a,this.z=n*l-s*o,this}projectOnVector(t){let e=t.lengthSq();if(e===0)return this.set(0,0,0);let n=t.dot(this)/e;return this.copy(t).multiplyScalar(n)}projectOnPlane(t){return Xc.copy(this).projectOnVector(t),this.sub(Xc)}reflect(t){return this.sub(Xc.copy(t).multiplyScalar(2*this.dot(t)))}angleTo(t){let e=Math.sqrt(this.lengthSq()*t.lengthSq());if(e===0)return Math.PI/2;let n=this.dot(t)/e;return Math.acos(Bt(n,-1,1))}distanceTo(t){return Math.sqrt(this.distanceToSquared(t))}distanceToSquared(t){let e=this.x-t.x,n=this.y-t.y,s=this.z-t.z;return e*e+n*n+s*s}manhattanDistanceTo(t){return Math.abs(this.x-t.x)+Math.abs(this.y-t.y)+Math.abs(this.z-t.z)}setFromSpherical(t){return this.setFromSphericalCoords(t.radius,t.phi,t.theta)}setFromSphericalCoords(t,e,n){let s=Math.sin(e)*t;return this.x=s*Math.sin(n),this.y=Math.cos(e)*t,this.z=s*Math.cos(n),this}setFromCylindrical(t){return this.setFromCylindricalCoords(t.radius,t.theta,t.y)}setFromCylindricalCoords(t,e,n){return this.x=t*Math.sin(e),this.y=n,this.z=t*Math.cos(e),this}setFromMatrixPosition(t){let e=t.elements;return this.x=e[12],this.y=e[13],this.z=e[14],this}setFromMatrixScale(t){let e=this.setFromMatrixColumn(t,0).length(),n=this.setFromMatrixColumn(t,1).length(),s=this.setFromMatrixColumn(t,2).length();return this.x=e,this.y=n,this.z=s,this}setFromMatrixColumn(t,e){return this.fromArray(t.elements,e*4)}setFromMatrix3Column(t,e){return this.fromArray(t.elements,e*3)}setFromEuler(t){return this.x=t._x,this.y=t._y,this.z=t._z,this}setFromColor(t){return this.x=t.r,this.y=t.g,this.z=t.b,this}equals(t){return t.x===this.x&&t.y===this.y&&t.z===this.z}fromArray(t,e=0){return this.x=t[e],this.y=t[e+1],this.z=t[e+2],this}toArray(t=[],e=0){return t[e]=this.x,t[e+1]=this.y,t[e+2]=this.z,t}fromBufferAttribute(t,e){return this.x=t.getX(e),this.y=t.getY(e),this.z=t.getZ(e),this}random(){return this.x=Math.random(),this.y=Math.random(),this.z=Math.random(),this}randomDirection(){let t=Math.random()*Math.PI*2,e=Math.random()*2-1,n=Math.sqrt(1-e*e);return this.x=n*Math.cos(t),this.y=e,this.z=n*Math.sin(t),this}*[Symbol.iterator](){yield this.x,yield this.y,yield this.z}},Xc=new N,Cf=new Kn,Dt=class{static{this.prototype.isMatrix3=!0}constructor(t,e,n,s,r,o,l,a,c){this.elements=[1,0,0,0,1,0,0,0,1],t!==void 0&&this.set(t,e,n,s,r,o,l,a,c)}set(t,e,n,s,r,o,l,a,c){let u=this.elements;return u[0]=t,u[1]=s,u[2]=l,u[3]=e,u[4]=r,u[5]=a,u[6]=n,u[7]=o,u[8]=c,this}identity(){return this.set(1,0,0,0,1,0,0,0,1),this}copy(t){let e=this.elements,n=t.elements;return e[0]=n[0],e[1]=n[1],e[2]=n[2],e[3]=n[3],e[4]=n[4],e[5]=n[5],e[6]=n[6],e[7]=n[7],e[8]=n[8],this}extractBasis(t,e,n){return t.setFromMatrix3Column(this,0),e.setFromMatrix3Column(this,1),n.setFromMatrix3Column(this,2),this}setFromMatrix4(t){let e=t.elements;return this.set(e[0],e[4],e[8],e[1],e[5],e[9],e[2],e[6],e[10]),this}multiply(t){return this.multiplyMatrices(this,t)}premultiply(t){return this.multiplyMatrices(t,this)}multiplyMatrices(t,e){let n=t.elements,s=e.elements,r=this.elements,o=n[0],l=n[3],a=n[6],c=n[1],u=n[4],h=n[7],f=n[2],d=n[5],g=n[8],y=s[0],p=s[3],m=s[6],x=s[1],M=s[4],v=s[7],S=s[2],A=s[5],_=s[8];return r[0]=o*y+l*x+a*S,r[3]=o*p+l*M+a*A,r[6]=o*m+l*v+a*_,r[1]=c*y+u*x+h*S,r[4]=c*p+u*M+h*A,r[7]=c*m+u*v+h*_,r[2]=f*y+d*x+g*S,r[5]=f*p+d*M+g*A,r[8]=f*m+d*v+g*_,this}multiplyScalar(t){let e=this.elements;return e[0]*=t,e[3]*=t,e[6]*=t,e[1]*=t,e[4]*=t,e[7]*=t,e[2]*=t,e[5]*=t,e[8]*=t,this}determinant(){let t=this.elements,e=t[0],n=t[1],s=t[2],r=t[3],o=t[4],l=t[5],a=t[6],c=t[7],u=t[8];return e*o*u-e*l*c-n*r*u+n*l*a+s*r*c-s*o*a}invert(){let t=this.elements,e=t[0],n=t[1],s=t[2],r=t[3],o=t[4],l=t[5],a=t[6],c=t[7],u=t[8],h=u*o-l*c,f=l*a-u*r,d=c*r-o*a,g=e*h+n*f+s*d;if(g===0)return this.set(0,0,0,0,0,0,0,0,0);let y=1/g;return t[0]=h*y,t[1]=(s*c-u*n)*y,t[2]=(l*n-s*o)*y,t[3]=f*y,t[4]=(u*e-s*a)*y,t[5]=(s*r-l*e)*y,t[6]=d*y,t[7]=(n*a-c*e)*y,t[8]=(o*e-n*r)*y,this}transpose(){let t,e=this.elements;return t=e[1],e[1]=e[3],e[3]=t,t=e[2],e[2]=e[6],e[6]=t,t=e[5],e[5]=e[7],e[7]=t,this}getNormalMatrix(t){return this.setFromMatrix4(t).invert().transpose()}transposeIntoArray(t){let e=this.elements;return t[0]=e[0],t[1]=e[3],t[2]=e[6],t[3]=e[1],t[4]=e[4],t[5]=e[7],t[6]=e[2],t[7]=e[5],t[8]=e[8],this}setUvTransform(t,e,n,s,r,o,l){let a=Math.cos(r),c=Math.sin(r);return this.set(n*a,n*c,-n*(a*o+c*l)+o+t,-s*c,s*a,-s*(-c*o+a*l)+l+e,0,0,1),this}scale(t,e){return Pr("Matrix3: .scale() is deprecated. Use .makeScale() instead."),this.premultiply(qc.makeScale(t,e)),this}rotate(t){return Pr("Matrix3: .rotate() is deprecated. Use .makeRotation() instead."),this.premultiply(qc.makeRotation(-t)),this}translate(t,e){return Pr("Matrix3: .translate() is deprecated. Use .makeTranslation() instead."),this.premultiply(qc.makeTranslation(t,e)),this}makeTranslation(t,e){return t.isVector2?this.set(1,0,t.x,0,1,t.y,0,0,1):this.set(1,0,t,0,1,e,0,0,1),this}makeRotation(t){let e=Math.cos(t),n=Math.sin(t);return this.set(e,-n,0,n,e,0,0,0,1),this}makeScale(t,e){return this.set(t,0,0,0,e,0,0,0,1),this}equals(t){let e=this.elements,n=t.elements;for(let s=0;s<9;s++)if(e[s]!==n[s])return!1;return!0}fromArray(t,e=0){for(let n=0;n<9;n++)this.elements[n]=t[n+e];return this}toArray(t=[],e=0){let n=this.elements;return t[e]=n[0],t[e+1]=n[1],t[e+2]=n[2],t[e+3]=n[3],t[e+4]=n[4],t[e+5]=n[5],t[e+6]=n[6],t[e+7]=n[7],t[e+8]=n[8],t}clone(){return new this.constructor().fromArray(this.elements)}},qc=new Dt,Pf=new Dt().set(.4123908,.3575843,.1804808,.212639,.7151687,.0721923,.0193308,.1191948,.9505322),If=new Dt().set(3.2409699,-1.5373832,-.4986108,-.9692436,1.8759675,.0415551,.0556301,-.203977,1.0569715);function Sg(){let i={enabled:!0,workingColorSpace:Lr,spaces:{},convert:function(s,r,o){return this.enabled===!1||r===o||!r||!o||(this.spaces[r].transfer===ne&&(s.r=gi(s.r),s.g=gi(s.g),s.b=gi(s.b)),this.spaces[r].primaries!==this.spaces[o].primaries&&(s.applyMatrix3(this.spaces[r].toXYZ),s.applyMatrix3(this.spaces[o].fromXYZ)),this.spaces[o].transfer===ne&&(s.r=zs(s.r),s.g=zs(s.g),s.b=zs(s.b))),s},workingToColorSpace:function(s,r){return this.convert(s,this.workingColorSpace,r)},colorSpaceToWorking:function(s,r){return this.convert(s,r,this.workingColorSpace)},getPrimaries:function(s){return this.spaces[s].primaries},getTransfer:function(s){return s===Si?Nr:this.spaces[s].transfer},getToneMappingMode:function(s){return this.spaces[s].outputColorSpaceConfig.toneMappingMode||"standard"},getLuminanceCoefficients:function(s,r=this.workingColorSpace){return s.fromArray(this.spaces[r].luminanceCoefficients)},define:function(s){Object.assign(this.spaces,s)},_getMatrix:function(s,r,o){return s.copy(this.spaces[o].fromXYZ).multiply(this.spaces[r].toXYZ)},_getDrawingBufferColorSpace:function(s){return this.spaces[s].outputColorSpaceConfig.drawingBufferColorSpace},_getUnpackColorSpace:function(s=this.workingColorSpace){return this.spaces[s].workingColorSpaceConfig.unpackColorSpace}},t=[.64,.33,.3,.6,.15,.06],e=[.2126,.7152,.0722],n=[.3127,.329];return i.define({[Lr]:{primaries:t,whitePoint:n,transfer:Nr,toXYZ:Pf,fromXYZ:If,luminanceCoefficients:e,workingColorSpaceConfig:{unpackColorSpace:gn},outputColorSpaceConfig:{drawingBufferColorSpace:gn}},[gn]:{primaries:t,whitePoint:n,transfer:ne,toXYZ:Pf,fromXYZ:If,luminanceCoefficients:e,outputColorSpaceConfig:{drawingBufferColorSpace:gn}}}),i}var Yt=Sg();function gi(i){return i<.04045?i*.0773993808:Math.pow(i*.9478672986+.0521327014,2.4)}function zs(i){return i<.0031308?i*12.92:1.055*Math.pow(i,.41666)-.055}var ws,xa=class{static getDataURL(t,e="image/png"){if(/^data:/i.test(t.src)||typeof HTMLCanvasElement>"u")return t.src;let n;if(t instanceof HTMLCanvasElement)n=t;else{ws===void 0&&(ws=Ur("canvas")),ws.width=t.width,ws.height=t.height;let s=ws.getContext("2d");t instanceof ImageData?s.putImageData(t,0,0):s.drawImage(t,0,0,t.width,t.height),n=ws}return n.toDataURL(e)}static sRGBToLinear(t){if(typeof HTMLImageElement<"u"&&t instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&t instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&t instanceof ImageBitmap){let e=Ur("canvas");e.width=t.width,e.height=t.height;let n=e.getContext("2d");n.drawImage(t,0,0,t.width,t.height);let s=n.getImageData(0,0,t.width,t.height),r=s.data;for(let o=0;o<r.length;o++)r[o]=gi(r[o]/255)*255;return n.putImageData(s,0,0),e}else if(t.data){let e=t.data.slice(0);for(let n=0;n<e.length;n++)e instanceof Uint8Array||e instanceof Uint8ClampedArray?e[n]=Math.floor(gi(e[n]/255)*255):e[n]=gi(e[n]);return{data:e,width:t.width,height:t.height}}else return Rt("ImageUtils.sRGBToLinear(): Unsupported image type. No color space conversion applied."),t}},bg=0,Hs=class{constructor(t=null){this.isTextureSource=!0,Object.defineProperty(this,"id",{value:bg++}),this.uuid=io(),this.data=t,this.dataReady=!0,this.version=0}getSize(t){let e=this.data;return typeof HTMLVideoElement<"u"&&e instanceof HTMLVideoElement?t.set(e.videoWidth,e.videoHeight,0):typeof VideoFrame<"u"&&e instanceof VideoFrame?t.set(e.displayWidth,e.displayHeight,0):e!==null?t.set(e.width||0,e.height||0,e.depth||0):t.set(0,0,0),t}set needsUpdate(t){t===!0&&this.version++}toJSON(t){let e=t===void 0||typeof t=="string";if(!e&&t.images[this.uuid]!==void 0)return t.images[this.uuid];let n={uuid:this.uuid,url:""},s=this.data;if(s!==null){let r;if(Array.isArray(s)){r=[];for(let o=0,l=s.length;o<l;o++)s[o].isDataTexture?r.push(Yc(s[o].image)):r.push(Yc(s[o]))}else r=Yc(s);n.url=r}return e||(t.images[this.uuid]=n),n}};function Yc(i){return typeof HTMLImageElement<"u"&&i instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&i instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&i instanceof ImageBitmap?xa.getDataURL(i):i.data?{data:Array.from(i.data),width:i.width,height:i.height,type:i.data.constructor.name}:(Rt("Texture: Unable to serialize Texture."),{})}var wg=0,$c=new N,hn=class i extends Jn{constructor(t=i.DEFAULT_IMAGE,e=i.DEFAULT_MAPPING,n=Zn,s=Zn,r=rn,o=vi,l=Mn,a=ln,c=i.DEFAULT_ANISOTROPY,u=Si){super(),this.isTexture=!0,Object.defineProperty(this,"id",{value:wg++}),this.uuid=io(),this.name="",this.source=new Hs(t),this.mipmaps=[],this.mapping=e,this.channel=0,this.wrapS=n,this.wrapT=s,this.magFilter=r,this.minFilter=o,this.anisotropy=c,this.format=l,this.internalFormat=null,this.type=a,this.offset=new Et(0,0),this.repeat=new Et(1,1),this.center=new Et(0,0),this.rotation=0,this.matrixAutoUpdate=!0,this.matrix=new Dt,this.generateMipmaps=!0,this.mipmapsAutoUpdate=!0,this.premultiplyAlpha=!1,this.flipY=!0,this.unpackAlignment=4,this.colorSpace=u,this.userData={},this.updateRanges=[],this.version=0,this.onUpdate=null,this.renderTarget=null,this.isRenderTargetTexture=!1,this.isArrayTexture=!!(t&&t.depth&&t.depth>1),this.pmremVersion=0,this.isPMREMTexture=!1,this.normalized=!1}get width(){return this.source.getSize($c).x}get height(){return this.source.getSize($c).y}get depth(){return this.source.getSize($c).z}get image(){return this.source.data}set image(t){this.source.data=t}updateMatrix(){this.matrix.setUvTransform(this.offset.x,this.offset.y,this.repeat.x,this.repeat.y,this.rotation,this.center.x,this.center.y)}addUpdateRange(t,e){this.updateRanges.push({start:t,count:e})}clearUpdateRanges(){this.updateRanges.length=0}clone(){return new this.constructor().copy(this)}copy(t){return this.name=t.name,this.source=t.source,this.mipmaps=t.mipmaps.slice(0),this.mapping=t.mapping,this.channel=t.channel,this.wrapS=t.wrapS,this.wrapT=t.wrapT,this.magFilter=t.magFilter,this.minFilter=t.minFilter,this.anisotropy=t.anisotropy,this.format=t.format,this.internalFormat=t.internalFormat,this.type=t.type,this.normalized=t.normalized,this.offset.copy(t.offset),this.repeat.copy(t.repeat),this.center.copy(t.center),this.rotation=t.rotation,this.matrixAutoUpdate=t.matrixAutoUpdate,this.matrix.copy(t.matrix),this.generateMipmaps=t.generateMipmaps,this.mipmapsAutoUpdate=t.mipmapsAutoUpdate,this.premultiplyAlpha=t.premultiplyAlpha,this.flipY=t.flipY,this.unpackAlignment=t.unpackAlignment,this.colorSpace=t.colorSpace,this.renderTarget=t.renderTarget,this.isRenderTargetTexture=t.isRenderTargetTexture,this.isPMREMTexture=t.isPMREMTexture,this.isArrayTexture=t.isArrayTexture,this.userData=JSON.parse(JSON.stringify(t.userData)),this.needsUpdate=!0,this}setValues(t){for(let e in t){let n=t[e];if(n===void 0){Rt(`Texture.setValues(): parameter '${e}' has value of undefined.`);continue}let s=this[e];if(s===void 0){Rt(`Texture.setValues(): property '${e}' does not exist.`);continue}s&&n&&s.isVector2&&n.isVector2||s&&n&&s.isVector3&&n.isVector3||s&&n&&s.isMatrix3&&n.isMatrix3?s.copy(n):this[e]=n}}toJSON(t){let e=t===void 0||typeof t=="string";if(!e&&t.textures[this.uuid]!==void 0)return t.textures[this.uuid];let n={metadata:{version:4.7,type:"Texture",generator:"Texture.toJSON"},uuid:this.uuid,name:this.name,image:this.source.toJSON(t).uuid,mapping:this.mapping,channel:this.channel,repeat:[this.repeat.x,this.repeat.y],offset:[this.offset.x,this.offset.y],center:[this.center.x,this.center.y],rotation:this.rotation,wrap:[this.wrapS,this.wrapT],format:this.format,internalFormat:this.internalFormat,type:this.type,normalized:this.normalized,colorSpace:this.colorSpace,minFilter:this.minFilter,magFilter:this.magFilter,anisotropy:this.anisotropy,flipY:this.flipY,generateMipmaps:this.generateMipmaps,mipmapsAutoUpdate:this.mipmapsAutoUpdate,premultiplyAlpha:this.premultiplyAlpha,unpackAlignment:this.unpackAlignment};return Object.keys(this.userData).length>0&&(n.userData=this.userData),e||(t.textures[this.uuid]=n),n}dispose(){this.dispatchEvent({type:"dispose"})}transformUv(t){if(this.mapping!==Nu)return t;if(t.applyMatrix3(this.matrix),t.x<0||t.x>1)switch(this.wrapS){case da:t.x=t.x-Math.floor(t.x);break;case Zn:t.x=t.x<0?0:1;break;case pa:Math.abs(Math.floor(t.x)%2)===1?t.x=Math.ceil(t.x)-t.x:t.x=t.x-Math.floor(t.x);break}if(t.y<0||t.y>1)switch(this.wrapT){case da:t.y=t.y-Math.floor(t.y);break;case Zn:t.y=t.y<0?0:1;break;case pa:Math.abs(Math.floor(t.y)%2)===1?t.y=Math.ceil(t.y)-t.y:t.y=t.y-Math.floor(t.y);break}return this.flipY&&(t.y=1-t.y),t}set needsUpdate(t){t===!0&&(this.version++,this.source.needsUpdate=!0)}set needsPMREMUpdate(t){t===!0&&this.pmremVersion++}};hn.DEFAULT_IMAGE=null;hn.DEFAULT_MAPPING=Nu;hn.DEFAULT_ANISOTROPY=1;var me=class{static{this.prototype.isVector4=!0}constructor(t=0,e=0,n=0,s=1){this.x=t,this.y=e,this.z=n,this.w=s}get width(){return this.z}set width(t){this.z=t}get height(){return this.w}set height(t){this.w=t}set(t,e,n,s){return this.x=t,this.y=e,this.z=n,this.w=s,this}setScalar(t){return this.x=t,this.y=t,this.z=t,this.w=t,this}setX(t){return this.x=t,this}setY(t){return this.y=t,this}setZ(t){return this.z=t,this}setW(t){return this.w=t,this}setComponent(t,e){switch(t){case 0:this.x=e;break;case 1:this.y=e;break;case 2:this.z=e;break;case 3:this.w=e;break;default:throw new Error("THREE.Vector4: index is out of range: "+t)}return this}getComponent(t){switch(t){case 0:return this.x;case 1:return this.y;case 2:return this.z;case 3:return this.w;default:throw new Error("THREE.Vector4: index is out of range: "+t)}}clone(){return new this.constructor(this.x,this.y,this.z,this.w)}copy(t){return this.x=t.x,this.y=t.y,this.z=t.z,this.w=t.w!==void 0?t.w:1,this}add(t){return this.x+=t.x,this.y+=t.y,this.z+=t.z,this.w+=t.w,this}addScalar(t){return this.x+=t,this.y+=t,this.z+=t,this.w+=t,this}addVectors(t,e){return this.x=t.x+e.x,this.y=t.y+e.y,this.z=t.z+e.z,this.w=t.w+e.w,this}addScaledVector(t,e){return this.x+=t.x*e,this.y+=t.y*e,this.z+=t.z*e,this.w+=t.w*e,this}sub(t){return this.x-=t.x,this.y-=t.y,this.z-=t.z,this.w-=t.w,this}subScalar(t){return this.x-=t,this.y-=t,this.z-=t,this.w-=t,this}subVectors(t,e){return this.x=t.x-e.x,this.y=t.y-e.y,this.z=t.z-e.z,this.w=t.w-e.w,this}multiply(t){return this.x*=t.x,this.y*=t.y,this.z*=t.z,this.w*=t.w,this}multiplyScalar(t){return this.x*=t,this.y*=t,this.z*=t,this.w*=t,this}applyMatrix4(t){let e=this.x,n=this.y,s=this.z,r=this.w,o=t.elements;return this.x=o[0]*e+o[4]*n+o[8]*s+o[12]*r,this.y=o[1]*e+o[5]*n+o[9]*s+o[13]*r,this.z=o[2]*e+o[6]*n+o[10]*s+o[14]*r,this.w=o[3]*e+o[7]*n+o[11]*s+o[15]*r,this}divide(t){return this.x/=t.x,this.y/=t.y,this.z/=t.z,this.w/=t.w,this}divideScalar(t){return this.multiplyScalar(1/t)}setAxisAngleFromQuaternion(t){this.w=2*Math.acos(t.w);let e=Math.sqrt(1-t.w*t.w);return e<1e-4?(this.x=1,this.y=0,this.z=0):(this.x=t.x/e,this.y=t.y/e,this.z=t.z/e),this}setAxisAngleFromRotationMatrix(t){let e,n,s,r,a=t.elements,c=a[0],u=a[4],h=a[8],f=a[1],d=a[5],g=a[9],y=a[2],p=a[6],m=a[10];if(Math.abs(u-f)<.01&&Math.abs(h-y)<.01&&Math.abs(g-p)<.01){if(Math.abs(u+f)<.1&&Math.abs(h+y)<.1&&Math.abs(g+p)<.1&&Math.abs(c+d+m-3)<.1)return this.set(1,0,0,0),this;e=Math.PI;let M=(c+1)/2,v=(d+1)/2,S=(m+1)/2,A=(u+f)/4,_=(h+y)/4,b=(g+p)/4;return M>v&&M>S?M<.01?(n=0,s=.707106781,r=.707106781):(n=Math.sqrt(M),s=A/n,r=_/n):v>S?v<.01?(n=.707106781,s=0,r=.707106781):(s=Math.sqrt(v),n=A/s,r=b/s):S<.01?(n=.707106781,s=.707106781,r=0):(r=Math.sqrt(S),n=_/r,s=b/r),this.set(n,s,r,e),this}let x=Math.sqrt((p-g)*(p-g)+(h-y)*(h-y)+(f-u)*(f-u));return Math.abs(x)<.001&&(x=1),this.x=(p-g)/x,this.y=(h-y)/x,this.z=(f-u)/x,this.w=Math.acos((c+d+m-1)/2),this}setFromMatrixPosition(t){let e=t.elements;return this.x=e[12],this.y=e[13],this.z=e[14],this.w=e[15],this}min(t){return this.x=Math.min(this.x,t.x),this.y=Math.min(this.y,t.y),this.z=Math.min(this.z,t.z),this.w=Math.min(this.w,t.w),this}max(t){return this.x=Math.max(this.x,t.x),this.y=Math.max(this.y,t.y),this.z=Math.max(this.z,t.z),this.w=Math.max(this.w,t.w),this}clamp(t,e){return this.x=Bt(this.x,t.x,e.x),this.y=Bt(this.y,t.y,e.y),this.z=Bt(this.z,t.z,e.z),this.w=Bt(this.w,t.w,e.w),this}clampScalar(t,e){return this.x=Bt(this.x,t,e),this.y=Bt(this.y,t,e),this.z=Bt(this.z,t,e),this.w=Bt(this.w,t,e),this}clampLength(t,e){let n=this.length();return this.divideScalar(n||1).multiplyScalar(Bt(n,t,e))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this.z=Math.floor(this.z),this.w=Math.floor(this.w),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this.z=Math.ceil(this.z),this.w=Math.ceil(this.w),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this.z=Math.round(this.z),this.w=Math.round(this.w),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this.z=Math.trunc(this.z),this.w=Math.trunc(this.w),this}negate(){return this.x=-this.x,this.y=-this.y,this.z=-this.z,this.w=-this.w,this}dot(t){return this.x*t.x+this.y*t.y+this.z*t.z+this.w*t.w}lengthSq(){return this.x*this.x+this.y*this.y+this.z*this.z+this.w*this.w}length(){return Math.sqrt(this.x*this.x+this.y*this.y+this.z*this.z+this.w*this.w)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)+Math.abs(this.z)+Math.abs(this.w)}normalize(){return this.divideScalar(this.length()||1)}setLength(t){return this.normalize().multiplyScalar(t)}lerp(t,e){return this.x+=(t.x-this.x)*e,this.y+=(t.y-this.y)*e,this.z+=(t.z-this.z)*e,this.w+=(t.w-this.w)*e,this}lerpVectors(t,e,n){return this.x=t.x+(e.x-t.x)*n,this.y=t.y+(e.y-t.y)*n,this.z=t.z+(e.z-t.z)*n,this.w=t.w+(e.w-t.w)*n,this}equals(t){return t.x===this.x&&t.y===this.y&&t.z===this.z&&t.w===this.w}fromArray(t,e=0){return this.x=t[e],this.y=t[e+1],this.z=t[e+2],this.w=t[e+3],this}toArray(t=[],e=0){return t[e]=this.x,t[e+1]=this.y,t[e+2]=this.z,t[e+3]=this.w,t}fromBufferAttribute(t,e){return this.x=t.getX(e),this.y=t.getY(e),this.z=t.getZ(e),this.w=t.getW(e),this}random(){return this.x=Math.random(),this.y=Math.random(),this.z=Math.random(),this.w=Math.random(),this}*[Symbol.iterator](){yield this.x,yield this.y,yield this.z,yield this.w}},_a=class extends Jn{constructor(t=1,e=1,n={}){super(),n=Object.assign({generateMipmaps:!1,internalFormat:null,minFilter:rn,depthBuffer:!0,stencilBuffer:!1,resolveColorBuffer:!0,resolveDepthBuffer:!0,resolveStencilBuffer:!0,storeMultisampledColorBuffer:!0,storeMultisampledDepthBuffer:!0,storeMultisampledStencilBuffer:!0,depthTexture:null,samples:0,count:1,depth:1,multiview:!1,useArrayDepthTexture:!1},n),this.isRenderTarget=!0,this.width=t,this.height=e,this.depth=n.depth,this.scissor=new me(0,0,t,e),this.scissorTest=!1,this.viewport=new me(0,0,t,e),this.textures=[];let s=n.count;for(let r=0;r<s;r++)this.textures[r]=new hn({width:t,height:e,depth:n.depth}),this.textures[r].isRenderTargetTexture=!0,this.textures[r].renderTarget=this;this._setTextureOptions(n),this.depthBuffer=n.depthBuffer,this.stencilBuffer=n.stencilBuffer,this.resolveColorBuffer=n.resolveColorBuffer,this.resolveDepthBuffer=n.resolveDepthBuffer,this.resolveStencilBuffer=n.resolveStencilBuffer,this.storeMultisampledColorBuffer=n.storeMultisampledColorBuffer,this.storeMultisampledDepthBuffer=n.storeMultisampledDepthBuffer,this.storeMultisampledStencilBuffer=n.storeMultisampledStencilBuffer,this._depthTexture=null,this.depthTexture=n.depthTexture,this.samples=n.samples,this.multiview=n.multiview,this.useArrayDepthTexture=n.useArrayDepthTexture}_setTextureOptions(t={}){let e={minFilter:rn,generateMipmaps:!1,flipY:!1,internalFormat:null};t.mapping!==void 0&&(e.mapping=t.mapping),t.wrapS!==void 0&&(e.wrapS=t.wrapS),t.wrapT!==void 0&&(e.wrapT=t.wrapT),t.wrapR!==void 0&&(e.wrapR=t.wrapR),t.magFilter!==void 0&&(e.magFilter=t.magFilter),t.minFilter!==void 0&&(e.minFilter=t.minFilter),t.format!==void 0&&(e.format=t.format),t.type!==void 0&&(e.type=t.type),t.anisotropy!==void 0&&(e.anisotropy=t.anisotropy),t.colorSpace!==void 0&&(e.colorSpace=t.colorSpace),t.flipY!==void 0&&(e.flipY=t.flipY),t.generateMipmaps!==void 0&&(e.generateMipmaps=t.generateMipmaps),t.mipmapsAutoUpdate!==void 0&&(e.mipmapsAutoUpdate=t.mipmapsAutoUpdate),t.internalFormat!==void 0&&(e.internalFormat=t.internalFormat);for(let n=0;n<this.textures.length;n++)this.textures[n].setValues(e)}get texture(){return this.textures[0]}set texture(t){this.textures[0]=t}set depthTexture(t){this._depthTexture!==null&&this._depthTexture.renderTarget===this&&(this._depthTexture.renderTarget=null),t!==null&&t.renderTarget===null&&(t.renderTarget=this),this._depthTexture=t}get depthTexture(){return this._depthTexture}setSize(t,e,n=1){if(this.width!==t||this.height!==e||this.depth!==n){this.width=t,this.height=e,this.depth=n;for(let s=0,r=this.textures.length;s<r;s++)this.textures[s].image.width=t,this.textures[s].image.height=e,this.textures[s].image.depth=n,this.textures[s].isData3DTexture!==!0&&(this.textures[s].isArrayTexture=this.textures[s].image.depth>1);this.dispose()}this.viewport.set(0,0,t,e),this.scissor.set(0,0,t,e)}clone(){return new this.constructor().copy(this)}copy(t){this.width=t.width,this.height=t.height,this.depth=t.depth,this.scissor.copy(t.scissor),this.scissorTest=t.scissorTest,this.viewport.copy(t.viewport),this.textures.length=0;for(let e=0,n=t.textures.length;e<n;e++){this.textures[e]=t.textures[e].clone(),this.textures[e].isRenderTargetTexture=!0,this.textures[e].renderTarget=this;let s=Object.assign({},t.textures[e].image);this.textures[e].source=new Hs(s)}if(this.depthBuffer=t.depthBuffer,this.stencilBuffer=t.stencilBuffer,this.resolveColorBuffer=t.resolveColorBuffer,this.resolveDepthBuffer=t.resolveDepthBuffer,this.resolveStencilBuffer=t.resolveStencilBuffer,this.storeMultisampledColorBuffer=t.storeMultisampledColorBuffer,this.storeMultisampledDepthBuffer=t.storeMultisampledDepthBuffer,this.storeMultisampledStencilBuffer=t.storeMultisampledStencilBuffer,t.depthTexture!==null)if(t.depthTexture.renderTarget===t){let e=t.depthTexture.clone();e.renderTarget=null,this.depthTexture=e}else this.depthTexture=t.depthTexture;else this.depthTexture=null;return this.samples=t.samples,this.multiview=t.multiview,this.useArrayDepthTexture=t.useArrayDepthTexture,this}dispose(){this.dispatchEvent({type:"dispose"})}},on=class extends _a{constructor(t=1,e=1,n={}){super(t,e,n),this.isWebGLRenderTarget=!0}},Fr=class extends hn{constructor(t=null,e=1,n=1,s=1){super(null),this.isDataArrayTexture=!0,this.image={data:t,width:e,height:n,depth:s},this.magFilter=Ce,this.minFilter=Ce,this.wrapR=Zn,this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1,this.layerUpdates=new Set}copy(t){return super.copy(t),this.wrapR=t.wrapR,this}addLayerUpdate(t){this.layerUpdates.add(t)}clearLayerUpdates(){this.layerUpdates.clear()}};var ya=class extends hn{constructor(t=null,e=1,n=1,s=1){super(null),this.isData3DTexture=!0,this.image={data:t,width:e,height:n,depth:s},this.magFilter=Ce,this.minFilter=Ce,this.wrapR=Zn,this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1}copy(t){return super.copy(t),this.wrapR=t.wrapR,this}};var zt=class i{static{this.prototype.isMatrix4=!0}constructor(t,e,n,s,r,o,l,a,c,u,h,f,d,g,y,p){this.elements=[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],t!==void 0&&this.set(t,e,n,s,r,o,l,a,c,u,h,f,d,g,y,p)}set(t,e,n,s,r,o,l,a,c,u,h,f,d,g,y,p){let m=this.elements;return m[0]=t,m[4]=e,m[8]=n,m[12]=s,m[1]=r,m[5]=o,m[9]=l,m[13]=a,m[2]=c,m[6]=u,m[10]=h,m[14]=f,m[3]=d,m[7]=g,m[11]=y,m[15]=p,this}identity(){return this.set(1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1),this}clone(){return new i().fromArray(this.elements)}copy(t){let e=this.elements,n=t.elements;return e[0]=n[0],e[1]=n[1],e[2]=n[2],e[3]=n[3],e[4]=n[4],e[5]=n[5],e[6]=n[6],e[7]=n[7],e[8]=n[8],e[9]=n[9],e[10]=n[10],e[11]=n[11],e[12]=n[12],e[13]=n[13],e[14]=n[14],e[15]=n[15],this}copyPosition(t){let e=this.elements,n=t.elements;return e[12]=n[12],e[13]=n[13],e[14]=n[14],this}setFromMatrix3(t){let e=t.elements;return this.set(e[0],e[3],e[6],0,e[1],e[4],e[7],0,e[2],e[5],e[8],0,0,0,0,1),this}extractBasis(t,e,n){return this.determinantAffine()===0?(t.set(1,0,0),e.set(0,1,0),n.set(0,0,1),this):(t.setFromMatrixColumn(this,0),e.setFromMatrixColumn(this,1),n.setFromMatrixColumn(this,2),this)}makeBasis(t,e,n){return this.set(t.x,e.x,n.x,0,t.y,e.y,n.y,0,t.z,e.z,n.z,0,0,0,0,1),this}extractRotation(t){if(t.determinantAffine()===0)return this.identity();let e=this.elements,n=t.elements,s=1/As.setFromMatrixColumn(t,0).length(),r=1/As.setFromMatrixColumn(t,1).length(),o=1/As.setFromMatrixColumn(t,2).length();return e[0]=n[0]*s,e[1]=n[1]*s,e[2]=n[2]*s,e[3]=0,e[4]=n[4]*r,e[5]=n[5]*r,e[6]=n[6]*r,e[7]=0,e[8]=n[8]*o,e[9]=n[9]*o,e[10]=n[10]*o,e[11]=0,e[12]=0,e[13]=0,e[14]=0,e[15]=1,this}makeRotationFromEuler(t){let e=this.elements,n=t.x,s=t.y,r=t.z,o=Math.cos(n),l=Math.sin(n),a=Math.cos(s),c=Math.sin(s),u=Math.cos(r),h=Math.sin(r);if(t.order==="XYZ"){let f=o*u,d=o*h,g=l*u,y=l*h;e[0]=a*u,e[4]=-a*h,e[8]=c,e[1]=d+g*c,e[5]=f-y*c,e[9]=-l*a,e[2]=y-f*c,e[6]=g+d*c,e[10]=o*a}else if(t.order==="YXZ"){let f=a*u,d=a*h,g=c*u,y=c*h;e[0]=f+y*l,e[4]=g*l-d,e[8]=o*c,e[1]=o*h,e[5]=o*u,e[9]=-l,e[2]=d*l-g,e[6]=y+f*l,e[10]=o*a}else if(t.order==="ZXY"){let f=a*u,d=a*h,g=c*u,y=c*h;e[0]=f-y*l,e[4]=-o*h,e[8]=g+d*l,e[1]=d+g*l,e[5]=o*u,e[9]=y-f*l,e[2]=-o*c,e[6]=l,e[10]=o*a}else if(t.order==="ZYX"){let f=o*u,d=o*h,g=l*u,y=l*h;e[0]=a*u,e[4]=g*c-d,e[8]=f*c+y,e[1]=a*h,e[5]=y*c+f,e[9]=d*c-g,e[2]=-c,e[6]=l*a,e[10]=o*a}else if(t.order==="YZX"){let f=o*a,d=o*c,g=l*a,y=l*c;e[0]=a*u,e[4]=y-f*h,e[8]=g*h+d,e[1]=h,e[5]=o*u,e[9]=-l*u,e[2]=-c*u,e[6]=d*h+g,e[10]=f-y*h}else if(t.order==="XZY"){let f=o*a,d=o*c,g=l*a,y=l*c;e[0]=a*u,e[4]=-h,e[8]=c*u,e[1]=f*h+y,e[5]=o*u,e[9]=d*h-g,e[2]=g*h-d,e[6]=l*u,e[10]=y*h+f}return e[3]=0,e[7]=0,e[11]=0,e[12]=0,e[13]=0,e[14]=0,e[15]=1,this}makeRotationFromQuaternion(t){return this.compose(Ag,t,Tg)}lookAt(t,e,n){let s=this.elements;return pn.subVectors(t,e),pn.lengthSq()===0&&(pn.z=1),pn.normalize(),Ii.crossVectors(n,pn),Ii.lengthSq()===0&&(Math.abs(n.z)===1?pn.x+=1e-4:pn.z+=1e-4,pn.normalize(),Ii.crossVectors(n,pn)),Ii.normalize(),Fo.crossVectors(pn,Ii),s[0]=Ii.x,s[4]=Fo.x,s[8]=pn.x,s[1]=Ii.y,s[5]=Fo.y,s[9]=pn.y,s[2]=Ii.z,s[6]=Fo.z,s[10]=pn.z,this}multiply(t){return this.multiplyMatrices(this,t)}premultiply(t){return this.multiplyMatrices(t,this)}multiplyMatrices(t,e){let n=t.elements,s=e.elements,r=this.elements,o=n[0],l=n[4],a=n[8],c=n[12],u=n[1],h=n[5],f=n[9],d=n[13],g=n[2],y=n[6],p=n[10],m=n[14],x=n[3],M=n[7],v=n[11],S=n[15],A=s[0],_=s[4],b=s[8],L=s[12],E=s[1],C=s[5],I=s[9],U=s[13],P=s[2],B=s[6],H=s[10],G=s[14],et=s[3],X=s[7],j=s[11],tt=s[15];return r[0]=o*A+l*E+a*P+c*et,r[4]=o*_+l*C+a*B+c*X,r[8]=o*b+l*I+a*H+c*j,r[12]=o*L+l*U+a*G+c*tt,r[1]=u*A+h*E+f*P+d*et,r[5]=u*_+h*C+f*B+d*X,r[9]=u*b+h*I+f*H+d*j,r[13]=u*L+h*U+f*G+d*tt,r[2]=g*A+y*E+p*P+m*et,r[6]=g*_+y*C+p*B+m*X,r[10]=g*b+y*I+p*H+m*j,r[14]=g*L+y*U+p*G+m*tt,r[3]=x*A+M*E+v*P+S*et,r[7]=x*_+M*C+v*B+S*X,r[11]=x*b+M*I+v*H+S*j,r[15]=x*L+M*U+v*G+S*tt,this}multiplyScalar(t){let e=this.elements;return e[0]*=t,e[4]*=t,e[8]*=t,e[12]*=t,e[1]*=t,e[5]*=t,e[9]*=t,e[13]*=t,e[2]*=t,e[6]*=t,e[10]*=t,e[14]*=t,e[3]*=t,e[7]*=t,e[11]*=t,e[15]*=t,this}determinant(){let t=this.elements,e=t[0],n=t[4],s=t[8],r=t[12],o=t[1],l=t[5],a=t[9],c=t[13],u=t[2],h=t[6],f=t[10],d=t[14],g=t[3],y=t[7],p=t[11],m=t[15],x=a*d-c*f,M=l*d-c*h,v=l*f-a*h,S=o*d-c*u,A=o*f-a*u,_=o*h-l*u;return e*(y*x-p*M+m*v)-n*(g*x-p*S+m*A)+s*(g*M-y*S+m*_)-r*(g*v-y*A+p*_)}determinantAffine(){let t=this.elements,e=t[0],n=t[4],s=t[8],r=t[1],o=t[5],l=t[9],a=t[2],c=t[6],u=t[10];return e*(o*u-l*c)-n*(r*u-l*a)+s*(r*c-o*a)}transpose(){let t=this.elements,e;return e=t[1],t[1]=t[4],t[4]=e,e=t[2],t[2]=t[8],t[8]=e,e=t[6],t[6]=t[9],t[9]=e,e=t[3],t[3]=t[12],t[12]=e,e=t[7],t[7]=t[13],t[13]=e,e=t[11],t[11]=t[14],t[14]=e,this}setPosition(t,e,n){let s=this.elements;return t.isVector3?(s[12]=t.x,s[13]=t.y,s[14]=t.z):(s[12]=t,s[13]=e,s[14]=n),this}invert(){let t=this.elements,e=t[0],n=t[1],s=t[2],r=t[3],o=t[4],l=t[5],a=t[6],c=t[7],u=t[8],h=t[9],f=t[10],d=t[11],g=t[12],y=t[13],p=t[14],m=t[15],x=e*l-n*o,M=e*a-s*o,v=e*c-r*o,S=n*a-s*l,A=n*c-r*l,_=s*c-r*a,b=u*y-h*g,L=u*p-f*g,E=u*m-d*g,C=h*p-f*y,I=h*m-d*y,U=f*m-d*p,P=x*U-M*I+v*C+S*E-A*L+_*b;if(P===0)return this.set(0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0);let B=1/P;return t[0]=(l*U-a*I+c*C)*B,t[1]=(s*I-n*U-r*C)*B,t[2]=(y*_-p*A+m*S)*B,t[3]=(f*A-h*_-d*S)*B,t[4]=(a*E-o*U-c*L)*B,t[5]=(e*U-s*E+r*L)*B,t[6]=(p*v-g*_-m*M)*B,t[7]=(u*_-f*v+d*M)*B,t[8]=(o*I-l*E+c*b)*B,t[9]=(n*E-e*I-r*b)*B,t[10]=(g*A-y*v+m*x)*B,t[11]=(h*v-u*A-d*x)*B,t[12]=(l*L-o*C-a*b)*B,t[13]=(e*C-n*L+s*b)*B,t[14]=(y*M-g*S-p*x)*B,t[15]=(u*S-h*M+f*x)*B,this}scale(t){let e=this.elements,n=t.x,s=t.y,r=t.z;return e[0]*=n,e[4]*=s,e[8]*=r,e[1]*=n,e[5]*=s,e[9]*=r,e[2]*=n,e[6]*=s,e[10]*=r,e[3]*=n,e[7]*=s,e[11]*=r,this}getMaxScaleOnAxis(){let t=this.elements,e=t[0]*t[0]+t[1]*t[1]+t[2]*t[2],n=t[4]*t[4]+t[5]*t[5]+t[6]*t[6],s=t[8]*t[8]+t[9]*t[9]+t[10]*t[10];return Math.sqrt(Math.max(e,n,s))}makeTranslation(t,e,n){return t.isVector3?this.set(1,0,0,t.x,0,1,0,t.y,0,0,1,t.z,0,0,0,1):this.set(1,0,0,t,0,1,0,e,0,0,1,n,0,0,0,1),this}makeRotationX(t){let e=Math.cos(t),n=Math.sin(t);return this.set(1,0,0,0,0,e,-n,0,0,n,e,0,0,0,0,1),this}makeRotationY(t){let e=Math.cos(t),n=Math.sin(t);return this.set(e,0,n,0,0,1,0,0,-n,0,e,0,0,0,0,1),this}makeRotationZ(t){let e=Math.cos(t),n=Math.sin(t);return this.set(e,-n,0,0,n,e,0,0,0,0,1,0,0,0,0,1),this}makeRotationAxis(t,e){let n=Math.cos(e),s=Math.sin(e),r=1-n,o=t.x,l=t.y,a=t.z,c=r*o,u=r*l;return this.set(c*o+n,c*l-s*a,c*a+s*l,0,c*l+s*a,u*l+n,u*a-s*o,0,c*a-s*l,u*a+s*o,r*a*a+n,0,0,0,0,1),this}makeScale(t,e,n){return this.set(t,0,0,0,0,e,0,0,0,0,n,0,0,0,0,1),this}makeShear(t,e,n,s,r,o){return this.set(1,n,r,0,t,1,o,0,e,s,1,0,0,0,0,1),this}compose(t,e,n){let s=this.elements,r=e._x,o=e._y,l=e._z,a=e._w,c=r+r,u=o+o,h=l+l,f=r*c,d=r*u,g=r*h,y=o*u,p=o*h,m=l*h,x=a*c,M=a*u,v=a*h,S=n.x,A=n.y,_=n.z;return s[0]=(1-(y+m))*S,s[1]=(d+v)*S,s[2]=(g-M)*S,s[3]=0,s[4]=(d-v)*A,s[5]=(1-(f+m))*A,s[6]=(p+x)*A,s[7]=0,s[8]=(g+M)*_,s[9]=(p-x)*_,s[10]=(1-(f+y))*_,s[11]=0,s[12]=t.x,s[13]=t.y,s[14]=t.z,s[15]=1,this}decompose(t,e,n){let s=this.elements;t.x=s[12],t.y=s[13],t.z=s[14];let r=this.determinantAffine();if(r===0)return n.set(1,1,1),e.identity(),this;let o=As.set(s[0],s[1],s[2]).length(),l=As.set(s[4],s[5],s[6]).length(),a=As.set(s[8],s[9],s[10]).length();r<0&&(o=-o),Bn.copy(this);let c=1/o,u=1/l,h=1/a;return Bn.elements[0]*=c,Bn.elements[1]*=c,Bn.elements[2]*=c,Bn.elements[4]*=u,Bn.elements[5]*=u,Bn.elements[6]*=u,Bn.elements[8]*=h,Bn.elements[9]*=h,Bn.elements[10]*=h,e.setFromRotationMatrix(Bn),n.x=o,n.y=l,n.z=a,this}makePerspective(t,e,n,s,r,o,l=Pn,a=!1){let c=this.elements,u=2*r/(e-t),h=2*r/(n-s),f=(e+t)/(e-t),d=(n+s)/(n-s),g,y;if(a)g=r/(o-r),y=o*r/(o-r);else if(l===Pn)g=-(o+r)/(o-r),y=-2*o*r/(o-r);else if(l===Dr)g=-o/(o-r),y=-o*r/(o-r);else throw new Error("THREE.Matrix4.makePerspective(): Invalid coordinate system: "+l);return c[0]=u,c[4]=0,c[8]=f,c[12]=0,c[1]=0,c[5]=h,c[9]=d,c[13]=0,c[2]=0,c[6]=0,c[10]=g,c[14]=y,c[3]=0,c[7]=0,c[11]=-1,c[15]=0,this}makeOrthographic(t,e,n,s,r,o,l=Pn,a=!1){let c=this.elements,u=2/(e-t),h=2/(n-s),f=-(e+t)/(e-t),d=-(n+s)/(n-s),g,y;if(a)g=1/(o-r),y=o/(o-r);else if(l===Pn)g=-2/(o-r),y=-(o+r)/(o-r);else if(l===Dr)g=-1/(o-r),y=-r/(o-r);else throw new Error("THREE.Matrix4.makeOrthographic(): Invalid coordinate system: "+l);return c[0]=u,c[4]=0,c[8]=0,c[12]=f,c[1]=0,c[5]=h,c[9]=0,c[13]=d,c[2]=0,c[6]=0,c[10]=g,c[14]=y,c[3]=0,c[7]=0,c[11]=0,c[15]=1,this}equals(t){let e=this.elements,n=t.elements;for(let s=0;s<16;s++)if(e[s]!==n[s])return!1;return!0}fromArray(t,e=0){for(let n=0;n<16;n++)this.elements[n]=t[n+e];return this}toArray(t=[],e=0){let n=this.elements;return t[e]=n[0],t[e+1]=n[1],t[e+2]=n[2],t[e+3]=n[3],t[e+4]=n[4],t[e+5]=n[5],t[e+6]=n[6],t[e+7]=n[7],t[e+8]=n[8],t[e+9]=n[9],t[e+10]=n[10],t[e+11]=n[11],t[e+12]=n[12],t[e+13]=n[13],t[e+14]=n[14],t[e+15]=n[15],t}},As=new N,Bn=new zt,Ag=new N(0,0,0),Tg=new N(1,1,1),Ii=new N,Fo=new N,pn=new N,Lf=new zt,Nf=new Kn,Fi=class i{constructor(t=0,e=0,n=0,s=i.DEFAULT_ORDER){this.isEuler=!0,this._x=t,this._y=e,this._z=n,this._order=s}get x(){return this._x}set x(t){this._x=t,this._onChangeCallback()}get y(){return this._y}set y(t){this._y=t,this._onChangeCallback()}get z(){return this._z}set z(t){this._z=t,this._onChangeCallback()}get order(){return this._order}set order(t){this._order=t,this._onChangeCallback()}set(t,e,n,s=this._order){return this._x=t,this._y=e,this._z=n,this._order=s,this._onChangeCallback(),this}clone(){return new this.constructor(this._x,this._y,this._z,this._order)}copy(t){return this._x=t._x,this._y=t._y,this._z=t._z,this._order=t._order,this._onChangeCallback(),this}setFromRotationMatrix(t,e=this._order,n=!0){let s=t.elements,r=s[0],o=s[4],l=s[8],a=s[1],c=s[5],u=s[9],h=s[2],f=s[6],d=s[10];switch(e){case"XYZ":this._y=Math.asin(Bt(l,-1,1)),Math.abs(l)<.9999999?(this._x=Math.atan2(-u,d),this._z=Math.atan2(-o,r)):(this._x=Math.atan2(f,c),this._z=0);break;case"YXZ":this._x=Math.asin(-Bt(u,-1,1)),Math.abs(u)<.9999999?(this._y=Math.atan2(l,d),this._z=Math.atan2(a,c)):(this._y=Math.atan2(-h,r),this._z=0);break;case"ZXY":this._x=Math.asin(Bt(f,-1,1)),Math.abs(f)<.9999999?(this._y=Math.atan2(-h,d),this._z=Math.atan2(-o,c)):(this._y=0,this._z=Math.atan2(a,r));break;case"ZYX":this._y=Math.asin(-Bt(h,-1,1)),Math.abs(h)<.9999999?(this._x=Math.atan2(f,d),this._z=Math.atan2(a,r)):(this._x=0,this._z=Math.atan2(-o,c));break;case"YZX":this._z=Math.asin(Bt(a,-1,1)),Math.abs(a)<.9999999?(this._x=Math.atan2(-u,c),this._y=Math.atan2(-h,r)):(this._x=0,this._y=Math.atan2(l,d));break;case"XZY":this._z=Math.asin(-Bt(o,-1,1)),Math.abs(o)<.9999999?(this._x=Math.atan2(f,c),this._y=Math.atan2(l,r)):(this._x=Math.atan2(-u,d),this._y=0);break;default:Rt("Euler: .setFromRotationMatrix() encountered an unknown order: "+e)}return this._order=e,n===!0&&this._onChangeCallback(),this}setFromQuaternion(t,e,n){return Lf.makeRotationFromQuaternion(t),this.setFromRotationMatrix(Lf,e,n)}setFromVector3(t,e=this._order){return this.set(t.x,t.y,t.z,e)}reorder(t){return Nf.setFromEuler(this),this.setFromQuaternion(Nf,t)}equals(t){return t._x===this._x&&t._y===this._y&&t._z===this._z&&t._order===this._order}fromArray(t){return this._x=t[0],this._y=t[1],this._z=t[2],t[3]!==void 0&&(this._order=t[3]),this._onChangeCallback(),this}toArray(t=[],e=0){return t[e]=this._x,t[e+1]=this._y,t[e+2]=this._z,t[e+3]=this._order,t}_onChange(t){return this._onChangeCallback=t,this}_onChangeCallback(){}*[Symbol.iterator](){yield this._x,yield this._y,yield this._z,yield this._order}};Fi.DEFAULT_ORDER="XYZ";var Ws=class{constructor(){this.mask=1}set(t){this.mask=(1<<t|0)>>>0}enable(t){this.mask|=1<<t|0}enableAll(){this.mask=-1}toggle(t){this.mask^=1<<t|0}disable(t){this.mask&=~(1<<t|0)}disableAll(){this.mask=0}test(t){return(this.mask&t.mask)!==0}isEnabled(t){return(this.mask&(1<<t|0))!==0}},Eg=0,Df=new N,Ts=new Kn,ui=new zt,Oo=new N,Ar=new N,Rg=new N,Cg=new Kn,Uf=new N(1,0,0),Ff=new N(0,1,0),Of=new N(0,0,1),Bf={type:"added"},Pg={type:"removed"},Es={type:"childadded",child:null},Zc={type:"childremoved",child:null},yn=class i extends Jn{constructor(){super(),this.isObject3D=!0,Object.defineProperty(this,"id",{value:Eg++}),this.uuid=io(),this.name="",this.type="Object3D",this.parent=null,this.children=[],this.up=i.DEFAULT_UP.clone();let t=new N,e=new Fi,n=new Kn,s=new N(1,1,1);function r(){n.setFromEuler(e,!1)}function o(){e.setFromQuaternion(n,void 0,!1)}e._onChange(r),n._onChange(o),Object.defineProperties(this,{position:{configurable:!0,enumerable:!0,value:t},rotation:{configurable:!0,enumerable:!0,value:e},quaternion:{configurable:!0,enumerable:!0,value:n},scale:{configurable:!0,enumerable:!0,value:s},modelViewMatrix:{value:new zt},normalMatrix:{value:new Dt}}),this.matrix=new zt,this.matrixWorld=new zt,this.matrixAutoUpdate=i.DEFAULT_MATRIX_AUTO_UPDATE,this.matrixWorldAutoUpdate=i.DEFAULT_MATRIX_WORLD_AUTO_UPDATE,this.matrixWorldNeedsUpdate=!1,this.layers=new Ws,this.visible=!0,this.castShadow=!1,this.receiveShadow=!1,this.frustumCulled=!0,this.renderOrder=0,this.animations=[],this.customDepthMaterial=void 0,this.customDistanceMaterial=void 0,this.static=!1,this.userData={},this.pivot=null}onBeforeShadow(){}onAfterShadow(){}onBeforeRender(){}onAfterRender(){}applyMatrix4(t){this.matrixAutoUpdate&&this.updateMatrix(),this.matrix.premultiply(t),this.matrix.decompose(this.position,this.quaternion,this.scale),this.pivot!==null&&this.position.copy(this.pivot).applyMatrix4(this.matrix).sub(this.pivot)}applyQuaternion(t){return this.quaternion.premultiply(t),this}setRotationFromAxisAngle(t,e){this.quaternion.setFromAxisAngle(t,e)}setRotationFromEuler(t){this.quaternion.setFromEuler(t,!0)}setRotationFromMatrix(t){this.quaternion.setFromRotationMatrix(t)}setRotationFromQuaternion(t){this.quaternion.copy(t)}rotateOnAxis(t,e){return Ts.setFromAxisAngle(t,e),this.quaternion.multiply(Ts),this}rotateOnWorldAxis(t,e){return Ts.setFromAxisAngle(t,e),this.quaternion.premultiply(Ts),this}rotateX(t){return this.rotateOnAxis(Uf,t)}rotateY(t){return this.rotateOnAxis(Ff,t)}rotateZ(t){return this.rotateOnAxis(Of,t)}translateOnAxis(t,e){return Df.copy(t).applyQuaternion(this.quaternion),this.position.add(Df.multiplyScalar(e)),this}translateX(t){return this.translateOnAxis(Uf,t)}translateY(t){return this.translateOnAxis(Ff,t)}translateZ(t){return this.translateOnAxis(Of,t)}localToWorld(t){return this.updateWorldMatrix(!0,!1),t.applyMatrix4(this.matrixWorld)}worldToLocal(t){return this.updateWorldMatrix(!0,!1),t.applyMatrix4(ui.copy(this.matrixWorld).invert())}lookAt(t,e,n){t.isVector3?Oo.copy(t):Oo.set(t,e,n);let s=this.parent;this.updateWorldMatrix(!0,!1),Ar.setFromMatrixPosition(this.matrixWorld),this.isCamera||this.isLight?ui.lookAt(Ar,Oo,this.up):ui.lookAt(Oo,Ar,this.up),this.quaternion.setFromRotationMatrix(ui),s&&(ui.extractRotation(s.matrixWorld),Ts.setFromRotationMatrix(ui),this.quaternion.premultiply(Ts.invert()))}add(t){if(arguments.length>1){for(let e=0;e<arguments.length;e++)this.add(arguments[e]);return this}return t===this?(Lt("Object3D.add: object can't be added as a child of itself.",t),this):(t&&t.isObject3D?(t.removeFromParent(),t.parent=this,this.children.push(t),t.dispatchEvent(Bf),Es.child=t,this.dispatchEvent(Es),Es.child=null):Lt("Object3D.add: object not an instance of THREE.Object3D.",t),this)}remove(t){if(arguments.length>1){for(let n=0;n<arguments.length;n++)this.remove(arguments[n]);return this}let e=this.children.indexOf(t);return e!==-1&&(t.parent=null,this.children.splice(e,1),t.dispatchEvent(Pg),Zc.child=t,this.dispatchEvent(Zc),Zc.child=null),this}removeFromParent(){let t=this.parent;return t!==null&&t.remove(this),this}clear(){return this.remove(...this.children)}attach(t){return this.updateWorldMatrix(!0,!1),ui.copy(this.matrixWorld).invert(),t.parent!==null&&(t.parent.updateWorldMatrix(!0,!1),ui.multiply(t.parent.matrixWorld)),t.applyMatrix4(ui),t.removeFromParent(),t.parent=this,this.children.push(t),t.updateWorldMatrix(!1,!0),t.dispatchEvent(Bf),Es.child=t,this.dispatchEvent(Es),Es.child=null,this}getObjectById(t){return this.getObjectByProperty("id",t)}getObjectByName(t){return this.getObjectByProperty("name",t)}getObjectByProperty(t,e){if(this[t]===e)return this;for(let n=0,s=this.children.length;n<s;n++){let o=this.children[n].getObjectByProperty(t,e);if(o!==void 0)return o}}getObjectsByProperty(t,e,n=[]){this[t]===e&&n.push(this);let s=this.children;for(let r=0,o=s.length;r<o;r++)s[r].getObjectsByProperty(t,e,n);return n}getWorldPosition(t){return this.updateWorldMatrix(!0,!1),t.setFromMatrixPosition(this.matrixWorld)}getWorldQuaternion(t){return this.updateWorldMatrix(!0,!1),this.matrixWorld.decompose(Ar,t,Rg),t}getWorldScale(t){return this.updateWorldMatrix(!0,!1),this.matrixWorld.decompose(Ar,Cg,t),t}getWorldDirection(t){this.updateWorldMatrix(!0,!1);let e=this.matrixWorld.elements;return t.set(e[8],e[9],e[10]).normalize()}raycast(){}intersectsFrustum(){return!0}traverse(t){t(this);let e=this.children;for(let n=0,s=e.length;n<s;n++)e[n].traverse(t)}traverseVisible(t){if(this.visible===!1)return;t(this);let e=this.children;for(let n=0,s=e.length;n<s;n++)e[n].traverseVisible(t)}traverseAncestors(t){let e=this.parent;e!==null&&(t(e),e.traverseAncestors(t))}updateMatrix(){this.matrix.compose(this.position,this.quaternion,this.scale);let t=this.pivot;if(t!==null){let e=t.x,n=t.y,s=t.z,r=this.matrix.elements;r[12]+=e-r[0]*e-r[4]*n-r[8]*s,r[13]+=n-r[1]*e-r[5]*n-r[9]*s,r[14]+=s-r[2]*e-r[6]*n-r[10]*s}this.matrixWorldNeedsUpdate=!0}updateMatrixWorld(t){this.matrixAutoUpdate&&this.updateMatrix(),(this.matrixWorldNeedsUpdate||t)&&(this.matrixWorldAutoUpdate===!0&&(this.parent===null?this.matrixWorld.copy(this.matrix):this.matrixWorld.multiplyMatrices(this.parent.matrixWorld,this.matrix)),this.matrixWorldNeedsUpdate=!1,t=!0);let e=this.children;for(let n=0,s=e.length;n<s;n++)e[n].updateMatrixWorld(t)}updateWorldMatrix(t,e,n=!1){let s=this.parent;if(t===!0&&s!==null&&s.updateWorldMatrix(!0,!1),this.matrixAutoUpdate&&this.updateMatrix(),(this.matrixWorldNeedsUpdate||n)&&(this.matrixWorldAutoUpdate===!0&&(this.parent===null?this.matrixWorld.copy(this.matrix):this.matrixWorld.multiplyMatrices(this.parent.matrixWorld,this.matrix)),this.matrixWorldNeedsUpdate=!1,n=!0),e===!0){let r=this.children;for(let o=0,l=r.length;o<l;o++)r[o].updateWorldMatrix(!1,!0,n)}}toJSON(t){let e=t===void 0||typeof t=="string",n={};e&&(t={geometries:{},materials:{},textures:{},images:{},shapes:{},skeletons:{},animations:{},nodes:{}},n.metadata={version:4.7,type:"Object",generator:"Object3D.toJSON"});let s={};s.uuid=this.uuid,s.type=this.type,s.name=this.name,s.castShadow=this.castShadow,s.receiveShadow=this.receiveShadow,s.visible=this.visible,s.frustumCulled=this.frustumCulled,s.renderOrder=this.renderOrder,s.static=this.static,s.matrixAutoUpdate=this.matrixAutoUpdate,Object.keys(this.userData).length>0&&(s.userData=this.userData),s.layers=this.layers.mask,s.matrix=this.matrix.toArray(),s.up=this.up.toArray(),this.pivot!==null&&(s.pivot=this.pivot.toArray()),this.morphTargetDictionary!==void 0&&(s.morphTargetDictionary=Object.assign({},this.morphTargetDictionary)),this.morphTargetInfluences!==void 0&&(s.morphTargetInfluences=this.morphTargetInfluences.slice()),this.isInstancedMesh&&(s.type="InstancedMesh",s.count=this.count,s.instanceMatrix=this.instanceMatrix.toJSON(),this.instanceColor!==null&&(s.instanceColor=this.instanceColor.toJSON())),this.isBatchedMesh&&(s.type="BatchedMesh",s.perObjectFrustumCulled=this.perObjectFrustumCulled,s.sortObjects=this.sortObjects,s.drawRanges=this._drawRanges,s.reservedRanges=this._reservedRanges,s.geometryInfo=this._geometryInfo.map(l=>({...l,boundingBox:l.boundingBox?l.boundingBox.toJSON():void 0,boundingSphere:l.boundingSphere?l.boundingSphere.toJSON():void 0})),s.instanceInfo=this._instanceInfo.map(l=>({...l})),s.availableInstanceIds=this._availableInstanceIds.slice(),s.availableGeometryIds=this._availableGeometryIds.slice(),s.nextIndexStart=this._nextIndexStart,s.nextVertexStart=this._nextVertexStart,s.geometryCount=this._geometryCount,s.maxInstanceCount=this._maxInstanceCount,s.maxVertexCount=this._maxVertexCount,s.maxIndexCount=this._maxIndexCount,s.geometryInitialized=this._geometryInitialized,s.matricesTexture=this._matricesTexture.toJSON(t),s.indirectTexture=this._indirectTexture.toJSON(t),this._colorsTexture!==null&&(s.colorsTexture=this._colorsTexture.toJSON(t)),this.boundingSphere!==null&&(s.boundingSphere=this.boundingSphere.toJSON()),this.boundingBox!==null&&(s.boundingBox=this.boundingBox.toJSON()));function r(l,a){return l[a.uuid]===void 0&&(l[a.uuid]=a.toJSON(t)),a.uuid}if(this.isScene)this.background&&(this.background.isColor?s.background=this.background.toJSON():this.background.isTexture&&(s.background=this.background.toJSON(t).uuid)),this.environment&&this.environment.isTexture&&this.environment.isRenderTargetTexture!==!0&&(s.environment=this.environment.toJSON(t).uuid);else if(this.isMesh||this.isLine||this.isPoints){s.geometry=r(t.geometries,this.geometry);let l=this.geometry.parameters;if(l!==void 0&&l.shapes!==void 0){let a=l.shapes;if(Array.isArray(a))for(let c=0,u=a.length;c<u;c++){let h=a[c];r(t.shapes,h)}else r(t.shapes,a)}}if(this.isSkinnedMesh&&(s.bindMode=this.bindMode,s.bindMatrix=this.bindMatrix.toArray(),this.skeleton!==void 0&&(r(t.skeletons,this.skeleton),s.skeleton=this.skeleton.uuid)),this.material!==void 0)if(Array.isArray(this.material)){let l=[];for(let a=0,c=this.material.length;a<c;a++)l.push(r(t.materials,this.material[a]));s.material=l}else s.material=r(t.materials,this.material);if(this.children.length>0){s.children=[];for(let l=0;l<this.children.length;l++)s.children.push(this.children[l].toJSON(t).object)}if(this.animations.length>0){s.animations=[];for(let l=0;l<this.animations.length;l++){let a=this.animations[l];s.animations.push(r(t.animations,a))}}if(e){let l=o(t.geometries),a=o(t.materials),c=o(t.textures),u=o(t.images),h=o(t.shapes),f=o(t.skeletons),d=o(t.animations),g=o(t.nodes);l.length>0&&(n.geometries=l),a.length>0&&(n.materials=a),c.length>0&&(n.textures=c),u.length>0&&(n.images=u),h.length>0&&(n.shapes=h),f.length>0&&(n.skeletons=f),d.length>0&&(n.animations=d),g.length>0&&(n.nodes=g)}return n.object=s,n;function o(l){let a=[];for(let c in l){let u=l[c];delete u.metadata,a.push(u)}return a}}clone(t){return new this.constructor().copy(this,t)}copy(t,e=!0){if(this.name=t.name,this.up.copy(t.up),this.position.copy(t.position),this.rotation.order=t.rotation.order,this.quaternion.copy(t.quaternion),this.scale.copy(t.scale),this.pivot=t.pivot!==null?t.pivot.clone():null,this.matrix.copy(t.matrix),this.matrixWorld.copy(t.matrixWorld),this.matrixAutoUpdate=t.matrixAutoUpdate,this.matrixWorldAutoUpdate=t.matrixWorldAutoUpdate,this.matrixWorldNeedsUpdate=t.matrixWorldNeedsUpdate,this.layers.mask=t.layers.mask,this.visible=t.visible,this.castShadow=t.castShadow,this.receiveShadow=t.receiveShadow,this.frustumCulled=t.frustumCulled,this.renderOrder=t.renderOrder,this.static=t.static,this.animations=t.animations.slice(),this.userData=JSON.parse(JSON.stringify(t.userData)),e===!0)for(let n=0;n<t.children.length;n++){let s=t.children[n];this.add(s.clone())}return this}dispose(){this.dispatchEvent({type:"dispose"})}};yn.DEFAULT_UP=new N(0,1,0);yn.DEFAULT_MATRIX_AUTO_UPDATE=!0;yn.DEFAULT_MATRIX_WORLD_AUTO_UPDATE=!0;var _n=class extends yn{constructor(){super(),this.isGroup=!0,this.type="Group"}},Ig={type:"move"},Xs=class{constructor(){this._targetRay=null,this._grip=null,this._hand=null}getHandSpace(){return this._hand===null&&(this._hand=new _n,this._hand.matrixAutoUpdate=!1,this._hand.visible=!1,this._hand.joints={},this._hand.inputState={pinching:!1}),this._hand}getTargetRaySpace(){return this._targetRay===null&&(this._targetRay=new _n,this._targetRay.matrixAutoUpdate=!1,this._targetRay.visible=!1,this._targetRay.hasLinearVelocity=!1,this._targetRay.linearVelocity=new N,this._targetRay.hasAngularVelocity=!1,this._targetRay.angularVelocity=new N),this._targetRay}getGripSpace(){return this._grip===null&&(this._grip=new _n,this._grip.matrixAutoUpdate=!1,this._grip.visible=!1,this._grip.hasLinearVelocity=!1,this._grip.linearVelocity=new N,this._grip.hasAngularVelocity=!1,this._grip.angularVelocity=new N,this._grip.eventsEnabled=!1),this._grip}dispatchEvent(t){return this._targetRay!==null&&this._targetRay.dispatchEvent(t),this._grip!==null&&this._grip.dispatchEvent(t),this._hand!==null&&this._hand.dispatchEvent(t),this}connect(t){if(t&&t.hand){let e=this._hand;if(e)for(let n of t.hand.values())this._getHandJoint(e,n)}return this.dispatchEvent({type:"connected",data:t}),this}disconnect(t){return this.dispatchEvent({type:"disconnected",data:t}),this._targetRay!==null&&(this._targetRay.visible=!1),this._grip!==null&&(this._grip.visible=!1),this._hand!==null&&(this._hand.visible=!1),this}update(t,e,n){let s=null,r=null,o=null,l=this._targetRay,a=this._grip,c=this._hand;if(t&&e.session.visibilityState!=="visible-blurred"){if(c&&t.hand){o=!0;for(let y of t.hand.values()){let p=e.getJointPose(y,n),m=this._getHandJoint(c,y);p!==null&&(m.matrix.fromArray(p.transform.matrix),m.matrix.decompose(m.position,m.quaternion,m.scale),m.matrixWorldNeedsUpdate=!0,m.jointRadius=p.radius),m.visible=p!==null}let u=c.joints["index-finger-tip"],h=c.joints["thumb-tip"],f=u.position.distanceTo(h.position),d=.02,g=.005;c.inputState.pinching&&f>d+g?(c.inputState.pinching=!1,this.dispatchEvent({type:"pinchend",handedness:t.handedness,target:this})):!c.inputState.pinching&&f<=d-g&&(c.inputState.pinching=!0,this.dispatchEvent({type:"pinchstart",handedness:t.handedness,target:this}))}else a!==null&&t.gripSpace&&(r=e.getPose(t.gripSpace,n),r!==null&&(a.matrix.fromArray(r.transform.matrix),a.matrix.decompose(a.position,a.quaternion,a.scale),a.matrixWorldNeedsUpdate=!0,r.linearVelocity?(a.hasLinearVelocity=!0,a.linearVelocity.copy(r.linearVelocity)):a.hasLinearVelocity=!1,r.angularVelocity?(a.hasAngularVelocity=!0,a.angularVelocity.copy(r.angularVelocity)):a.hasAngularVelocity=!1,a.eventsEnabled&&a.dispatchEvent({type:"gripUpdated",data:t,target:this})));l!==null&&(s=e.getPose(t.targetRaySpace,n),s===null&&r!==null&&(s=r),s!==null&&(l.matrix.fromArray(s.transform.matrix),l.matrix.decompose(l.position,l.quaternion,l.scale),l.matrixWorldNeedsUpdate=!0,s.linearVelocity?(l.hasLinearVelocity=!0,l.linearVelocity.copy(s.linearVelocity)):l.hasLinearVelocity=!1,s.angularVelocity?(l.hasAngularVelocity=!0,l.angularVelocity.copy(s.angularVelocity)):l.hasAngularVelocity=!1,this.dispatchEvent(Ig)))}return l!==null&&(l.visible=s!==null),a!==null&&(a.visible=r!==null),c!==null&&(c.visible=o!==null),this}_getHandJoint(t,e){if(t.joints[e.jointName]===void 0){let n=new _n;n.matrixAutoUpdate=!1,n.visible=!1,t.joints[e.jointName]=n,t.add(n)}return t.joints[e.jointName]}},zd={aliceblue:15792383,antiquewhite:16444375,aqua:65535,aquamarine:8388564,azure:15794175,beige:16119260,bisque:16770244,black:0,blanchedalmond:16772045,blue:255,blueviolet:9055202,brown:10824234,burlywood:14596231,cadetblue:6266528,chartreuse:8388352,chocolate:13789470,coral:16744272,cornflowerblue:6591981,cornsilk:16775388,crimson:14423100,cyan:65535,darkblue:139,darkcyan:35723,darkgoldenrod:12092939,darkgray:11119017,darkgreen:25600,darkgrey:11119017,darkkhaki:12433259,darkmagenta:9109643,darkolivegreen:5597999,darkorange:16747520,darkorchid:10040012,darkred:9109504,darksalmon:15308410,darkseagreen:9419919,darkslateblue:4734347,darkslategray:3100495,darkslategrey:3100495,darkturquoise:52945,darkviolet:9699539,deeppink:16716947,deepskyblue:49151,dimgray:6908265,dimgrey:6908265,dodgerblue:2003199,firebrick:11674146,floralwhite:16775920,forestgreen:2263842,fuchsia:16711935,gainsboro:14474460,ghostwhite:16316671,gold:16766720,goldenrod:14329120,gray:8421504,green:32768,greenyellow:11403055,grey:8421504,honeydew:15794160,hotpink:16738740,indianred:13458524,indigo:4915330,ivory:16777200,khaki:15787660,lavender:15132410,lavenderblush:16773365,lawngreen:8190976,lemonchiffon:16775885,lightblue:11393254,lightcoral:15761536,lightcyan:14745599,lightgoldenrodyellow:16448210,lightgray:13882323,lightgreen:9498256,lightgrey:13882323,lightpink:16758465,lightsalmon:16752762,lightseagreen:2142890,lightskyblue:8900346,lightslategray:7833753,lightslategrey:7833753,lightsteelblue:11584734,lightyellow:16777184,lime:65280,limegreen:3329330,linen:16445670,magenta:16711935,maroon:8388608,mediumaquamarine:6737322,mediumblue:205,mediumorchid:12211667,mediumpurple:9662683,mediumseagreen:3978097,mediumslateblue:8087790,mediumspringgreen:64154,mediumturquoise:4772300,mediumvioletred:13047173,midnightblue:1644912,mintcream:16121850,mistyrose:16770273,moccasin:16770229,navajowhite:16768685,navy:128,oldlace:16643558,olive:8421376,olivedrab:7048739,orange:16753920,orangered:16729344,orchid:14315734,palegoldenrod:15657130,palegreen:10025880,paleturquoise:11529966,palevioletred:14381203,papayawhip:16773077,peachpuff:16767673,peru:13468991,pink:16761035,plum:14524637,powderblue:11591910,purple:8388736,rebeccapurple:6697881,red:16711680,rosybrown:12357519,royalblue:4286945,saddlebrown:9127187,salmon:16416882,sandybrown:16032864,seagreen:3050327,seashell:16774638,sienna:10506797,silver:12632256,skyblue:8900331,slateblue:6970061,slategray:7372944,slategrey:7372944,snow:16775930,springgreen:65407,steelblue:4620980,tan:13808780,teal:32896,thistle:14204888,tomato:16737095,turquoise:4251856,violet:15631086,wheat:16113331,white:16777215,whitesmoke:16119285,yellow:16776960,yellowgreen:10145074},Li={h:0,s:0,l:0},Bo={h:0,s:0,l:0};function Jc(i,t,e){return e<0&&(e+=1),e>1&&(e-=1),e<1/6?i+(t-i)*6*e:e<1/2?t:e<2/3?i+(t-i)*6*(2/3-e):i}var Zt=class{constructor(t,e,n){return this.isColor=!0,this.r=1,this.g=1,this.b=1,this.set(t,e,n)}set(t,e,n){if(e===void 0&&n===void 0){let s=t;s&&s.isColor?this.copy(s):typeof s=="number"?this.setHex(s):typeof s=="string"&&this.setStyle(s)}else this.setRGB(t,e,n);return this}setScalar(t){return this.r=t,this.g=t,this.b=t,this}setHex(t,e=gn){return t=Math.floor(t),this.r=(t>>16&255)/255,this.g=(t>>8&255)/255,this.b=(t&255)/255,Yt.colorSpaceToWorking(this,e),this}setRGB(t,e,n,s=Yt.workingColorSpace){return this.r=t,this.g=e,this.b=n,Yt.colorSpaceToWorking(this,s),this}setHSL(t,e,n,s=Yt.workingColorSpace){if(t=yg(t,1),e=Bt(e,0,1),n=Bt(n,0,1),e===0)this.r=this.g=this.b=n;else{let r=n<=.5?n*(1+e):n+e-n*e,o=2*n-r;this.r=Jc(o,r,t+1/3),this.g=Jc(o,r,t),this.b=Jc(o,r,t-1/3)}return Yt.colorSpaceToWorking(this,s),this}setStyle(t,e=gn){function n(r){r!==void 0&&parseFloat(r)<1&&Rt("Color: Alpha component of "+t+" will be ignored.")}let s;if(s=/^(\w+)\(([^\)]*)\)/.exec(t)){let r,o=s[1],l=s[2];switch(o){case"rgb":case"rgba":if(r=/^\s*(\d+)\s*,\s*(\d+)\s*,\s*(\d+)\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(l))return n(r[4]),this.setRGB(Math.min(255,parseInt(r[1],10))/255,Math.min(255,parseInt(r[2],10))/255,Math.min(255,parseInt(r[3],10))/255,e);if(r=/^\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(l))return n(r[4]),this.setRGB(Math.min(100,parseFloat(r[1]))/100,Math.min(100,parseFloat(r[2]))/100,Math.min(100,parseFloat(r[3]))/100,e);break;case"hsl":case"hsla":if(r=/^\s*([+-]?(?:\d+(?:\.\d+)?|\.\d+))\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(l))return n(r[4]),this.setHSL(parseFloat(r[1])/360,parseFloat(r[2])/100,parseFloat(r[3])/100,e);break;default:Rt("Color: Unknown color model "+t)}}else if(s=/^\#([A-Fa-f\d]+)$/.exec(t)){let r=s[1],o=r.length;if(o===3)return this.setRGB(parseInt(r.charAt(0),16)/15,parseInt(r.charAt(1),16)/15,parseInt(r.charAt(2),16)/15,e);if(o===6)return this.setHex(parseInt(r,16),e);Rt("Color: Invalid hex color "+t)}else if(t&&t.length>0)return this.setColorName(t,e);return this}setColorName(t,e=gn){let n=zd[t.toLowerCase()];return n!==void 0?this.setHex(n,e):Rt("Color: Unknown color "+t),this}clone(){return new this.constructor(this.r,this.g,this.b)}copy(t){return this.r=t.r,this.g=t.g,this.b=t.b,this}copySRGBToLinear(t){return this.r=gi(t.r),this.g=gi(t.g),this.b=gi(t.b),this}copyLinearToSRGB(t){return this.r=zs(t.r),this.g=zs(t.g),this.b=zs(t.b),this}convertSRGBToLinear(){return this.copySRGBToLinear(this),this}convertLinearToSRGB(){return this.copyLinearToSRGB(this),this}getHex(t=gn){return Yt.workingToColorSpace(Qe.copy(this),t),Math.round(Bt(Qe.r*255,0,255))*65536+Math.round(Bt(Qe.g*255,0,255))*256+Math.round(Bt(Qe.b*255,0,255))}getHexString(t=gn){return("000000"+this.getHex(t).toString(16)).slice(-6)}getHSL(t,e=Yt.workingColorSpace){Yt.workingToColorSpace(Qe.copy(this),e);let n=Qe.r,s=Qe.g,r=Qe.b,o=Math.max(n,s,r),l=Math.min(n,s,r),a,c,u=(l+o)/2;if(l===o)a=0,c=0;else{let h=o-l;switch(c=u<=.5?h/(o+l):h/(2-o-l),o){case n:a=(s-r)/h+(s<r?6:0);break;case s:a=(r-n)/h+2;break;case r:a=(n-s)/h+4;break}a/=6}return t.h=a,t.s=c,t.l=u,t}getRGB(t,e=Yt.workingColorSpace){return Yt.workingToColorSpace(Qe.copy(this),e),t.r=Qe.r,t.g=Qe.g,t.b=Qe.b,t}getStyle(t=gn){Yt.workingToColorSpace(Qe.copy(this),t);let e=Qe.r,n=Qe.g,s=Qe.b;return t!==gn?`color(${t} ${e.toFixed(3)} ${n.toFixed(3)} ${s.toFixed(3)})`:`rgb(${Math.round(e*255)},${Math.round(n*255)},${Math.round(s*255)})`}offsetHSL(t,e,n){return this.getHSL(Li),this.setHSL(Li.h+t,Li.s+e,Li.l+n)}add(t){return this.r+=t.r,this.g+=t.g,this.b+=t.b,this}addColors(t,e){return this.r=t.r+e.r,this.g=t.g+e.g,this.b=t.b+e.b,this}addScalar(t){return this.r+=t,this.g+=t,this.b+=t,this}sub(t){return this.r=Math.max(0,this.r-t.r),this.g=Math.max(0,this.g-t.g),this.b=Math.max(0,this.b-t.b),this}multiply(t){return this.r*=t.r,this.g*=t.g,this.b*=t.b,this}multiplyScalar(t){return this.r*=t,this.g*=t,this.b*=t,this}lerp(t,e){return this.r+=(t.r-this.r)*e,this.g+=(t.g-this.g)*e,this.b+=(t.b-this.b)*e,this}lerpColors(t,e,n){return this.r=t.r+(e.r-t.r)*n,this.g=t.g+(e.g-t.g)*n,this.b=t.b+(e.b-t.b)*n,this}lerpHSL(t,e){this.getHSL(Li),t.getHSL(Bo);let n=Wc(Li.h,Bo.h,e),s=Wc(Li.s,Bo.s,e),r=Wc(Li.l,Bo.l,e);return this.setHSL(n,s,r),this}setFromVector3(t){return this.r=t.x,this.g=t.y,this.b=t.z,this}applyMatrix3(t){let e=this.r,n=this.g,s=this.b,r=t.elements;return this.r=r[0]*e+r[3]*n+r[6]*s,this.g=r[1]*e+r[4]*n+r[7]*s,this.b=r[2]*e+r[5]*n+r[8]*s,this}equals(t){return t.r===this.r&&t.g===this.g&&t.b===this.b}fromArray(t,e=0){return this.r=t[e],this.g=t[e+1],this.b=t[e+2],this}toArray(t=[],e=0){return t[e]=this.r,t[e+1]=this.g,t[e+2]=this.b,t}fromBufferAttribute(t,e){return this.r=t.getX(e),this.g=t.getY(e),this.b=t.getZ(e),this}toJSON(){return this.getHex()}*[Symbol.iterator](){yield this.r,yield this.g,yield this.b}},Qe=new Zt;Zt.NAMES=zd;var Oi=class extends yn{constructor(){super(),this.isScene=!0,this.type="Scene",this.background=null,this.environment=null,this.fog=null,this.backgroundBlurriness=0,this.backgroundIntensity=1,this.backgroundRotation=new Fi,this.environmentIntensity=1,this.environmentRotation=new Fi,this.overrideMaterial=null,typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("observe",{detail:this}))}copy(t,e){return super.copy(t,e),this.background=t.background!==null?t.background.clone():null,this.environment=t.environment!==null?t.environment.clone():null,this.fog=t.fog!==null?t.fog.clone():null,this.backgroundBlurriness=t.backgroundBlurriness,this.backgroundIntensity=t.backgroundIntensity,this.backgroundRotation.copy(t.backgroundRotation),this.environmentIntensity=t.environmentIntensity,this.environmentRotation.copy(t.environmentRotation),this.overrideMaterial=t.overrideMaterial!==null?t.overrideMaterial.clone():null,this.matrixAutoUpdate=t.matrixAutoUpdate,this}toJSON(t){let e=super.toJSON(t);return this.fog!==null&&(e.object.fog=this.fog.toJSON()),e.object.backgroundBlurriness=this.backgroundBlurriness,e.object.backgroundIntensity=this.backgroundIntensity,e.object.backgroundRotation=this.backgroundRotation.toArray(),e.object.environmentIntensity=this.environmentIntensity,e.object.environmentRotation=this.environmentRotation.toArray(),e}},zn=new N,hi=new N,Kc=new N,fi=new N,Rs=new N,Cs=new N,zf=new N,Qc=new N,jc=new N,tu=new N,eu=new me,nu=new me,iu=new me,ke=class i{constructor(t=new N,e=new N,n=new N){this.a=t,this.b=e,this.c=n}static getNormal(t,e,n,s){s.subVectors(n,e),zn.subVectors(t,e),s.cross(zn);let r=s.lengthSq();return r>0?s.multiplyScalar(1/Math.sqrt(r)):s.set(0,0,0)}static getBarycoord(t,e,n,s,r){zn.subVectors(s,e),hi.subVectors(n,e),Kc.subVectors(t,e);let o=zn.dot(zn),l=zn.dot(hi),a=zn.dot(Kc),c=hi.dot(hi),u=hi.dot(Kc),h=o*c-l*l;if(h===0)return r.set(0,0,0),null;let f=1/h,d=(c*a-l*u)*f,g=(o*u-l*a)*f;return r.set(1-d-g,g,d)}static containsPoint(t,e,n,s){return this.getBarycoord(t,e,n,s,fi)===null?!1:fi.x>=0&&fi.y>=0&&fi.x+fi.y<=1}static getInterpolation(t,e,n,s,r,o,l,a){return this.getBarycoord(t,e,n,s,fi)===null?(a.x=0,a.y=0,"z"in a&&(a.z=0),"w"in a&&(a.w=0),null):(a.setScalar(0),a.addScaledVector(r,fi.x),a.addScaledVector(o,fi.y),a.addScaledVector(l,fi.z),a)}static getInterpolatedAttribute(t,e,n,s,r,o){return eu.setScalar(0),nu.setScalar(0),iu.setScalar(0),eu.fromBufferAttribute(t,e),nu.fromBufferAttribute(t,n),iu.fromBufferAttribute(t,s),o.setScalar(0),o.addScaledVector(eu,r.x),o.addScaledVector(nu,r.y),o.addScaledVector(iu,r.z),o}static isFrontFacing(t,e,n,s){return zn.subVectors(n,e),hi.subVectors(t,e),zn.cross(hi).dot(s)<0}set(t,e,n){return this.a.copy(t),this.b.copy(e),this.c.copy(n),this}setFromPointsAndIndices(t,e,n,s){return this.a.copy(t[e]),this.b.copy(t[n]),this.c.copy(t[s]),this}setFromAttributeAndIndices(t,e,n,s){return this.a.fromBufferAttribute(t,e),this.b.fromBufferAttribute(t,n),this.c.fromBufferAttribute(t,s),this}clone(){return new this.constructor().copy(this)}copy(t){return this.a.copy(t.a),this.b.copy(t.b),this.c.copy(t.c),this}getArea(){return zn.subVectors(this.c,this.b),hi.subVectors(this.a,this.b),zn.cross(hi).length()*.5}getMidpoint(t){return t.addVectors(this.a,this.b).add(this.c).multiplyScalar(1/3)}getNormal(t){return i.getNormal(this.a,this.b,this.c,t)}getPlane(t){return t.setFromCoplanarPoints(this.a,this.b,this.c)}getBarycoord(t,e){return i.getBarycoord(t,this.a,this.b,this.c,e)}getInterpolation(t,e,n,s,r){return i.getInterpolation(t,this.a,this.b,this.c,e,n,s,r)}containsPoint(t){return i.containsPoint(t,this.a,this.b,this.c)}isFrontFacing(t){return i.isFrontFacing(this.a,this.b,this.c,t)}intersectsBox(t){return t.intersectsTriangle(this)}closestPointToPoint(t,e){let n=this.a,s=this.b,r=this.c,o,l;Rs.subVectors(s,n),Cs.subVectors(r,n),Qc.subVectors(t,n);let a=Rs.dot(Qc),c=Cs.dot(Qc);if(a<=0&&c<=0)return e.copy(n);jc.subVectors(t,s);let u=Rs.dot(jc),h=Cs.dot(jc);if(u>=0&&h<=u)return e.copy(s);let f=a*h-u*c;if(f<=0&&a>=0&&u<=0&&a-u>0)return o=a/(a-u),e.copy(n).addScaledVector(Rs,o);tu.subVectors(t,r);let d=Rs.dot(tu),g=Cs.dot(tu);if(g>=0&&d<=g)return e.copy(r);let y=d*c-a*g;if(y<=0&&c>=0&&g<=0)return l=c/(c-g),e.copy(n).addScaledVector(Cs,l);let p=u*g-d*h;if(p<=0&&h-u>=0&&d-g>=0)return zf.subVectors(r,s),l=(h-u)/(h-u+(d-g)),e.copy(s).addScaledVector(zf,l);let m=1/(p+y+f);return o=y*m,l=f*m,e.copy(n).addScaledVector(Rs,o).addScaledVector(Cs,l)}equals(t){return t.a.equals(this.a)&&t.b.equals(this.b)&&t.c.equals(this.c)}},_e=class{constructor(t=new N(1/0,1/0,1/0),e=new N(-1/0,-1/0,-1/0)){this.isBox3=!0,this.min=t,this.max=e}set(t,e){return this.min.copy(t),this.max.copy(e),this}setFromArray(t){this.makeEmpty();for(let e=0,n=t.length;e<n;e+=3)this.expandByPoint(kn.fromArray(t,e));return this}setFromBufferAttribute(t){this.makeEmpty();for(let e=0,n=t.count;e<n;e++)this.expandByPoint(kn.fromBufferAttribute(t,e));return this}setFromPoints(t){this.makeEmpty();for(let e=0,n=t.length;e<n;e++)this.expandByPoint(t[e]);return this}setFromCenterAndSize(t,e){let n=kn.copy(e).multiplyScalar(.5);return this.min.copy(t).sub(n),this.max.copy(t).add(n),this}setFromObject(t,e=!1){return this.makeEmpty(),this.expandByObject(t,e)}clone(){return new this.constructor().copy(this)}copy(t){return this.min.copy(t.min),this.max.copy(t.max),this}makeEmpty(){return this.min.x=this.min.y=this.min.z=1/0,this.max.x=this.max.y=this.max.z=-1/0,this}isEmpty(){return this.max.x<this.min.x||this.max.y<this.min.y||this.max.z<this.min.z}getCenter(t){return this.isEmpty()?t.set(0,0,0):t.addVectors(this.min,this.max).multiplyScalar(.5)}getSize(t){return this.isEmpty()?t.set(0,0,0):t.subVectors(this.max,this.min)}expandByPoint(t){return this.min.min(t),this.max.max(t),this}expandByVector(t){return this.min.sub(t),this.max.add(t),this}expandByScalar(t){return this.min.addScalar(-t),this.max.addScalar(t),this}expandByObject(t,e=!1){t.updateWorldMatrix(!1,!1);let n=t.geometry;if(n!==void 0){let r=n.getAttribute("position");if(e===!0&&r!==void 0&&t.isInstancedMesh!==!0&&t.isBatchedMesh!==!0)for(let o=0,l=r.count;o<l;o++)t.isMesh===!0?t.getVertexPosition(o,kn):kn.fromBufferAttribute(r,o),kn.applyMatrix4(t.matrixWorld),this.expandByPoint(kn);else t.boundingBox!==void 0?(t.boundingBox===null&&t.computeBoundingBox(),zo.copy(t.boundingBox)):(n.boundingBox===null&&n.computeBoundingBox(),zo.copy(n.boundingBox)),zo.applyMatrix4(t.matrixWorld),this.union(zo)}let s=t.children;for(let r=0,o=s.length;r<o;r++)this.expandByObject(s[r],e);return this}containsPoint(t){return t.x>=this.min.x&&t.x<=this.max.x&&t.y>=this.min.y&&t.y<=this.max.y&&t.z>=this.min.z&&t.z<=this.max.z}containsBox(t){return this.min.x<=t.min.x&&t.max.x<=this.max.x&&this.min.y<=t.min.y&&t.max.y<=this.max.y&&this.min.z<=t.min.z&&t.max.z<=this.max.z}getParameter(t,e){return e.set((t.x-this.min.x)/(this.max.x-this.min.x),(t.y-this.min.y)/(this.max.y-this.min.y),(t.z-this.min.z)/(this.max.z-this.min.z))}intersectsBox(t){return t.max.x>=this.min.x&&t.min.x<=this.max.x&&t.max.y>=this.min.y&&t.min.y<=this.max.y&&t.max.z>=this.min.z&&t.min.z<=this.max.z}intersectsSphere(t){return this.clampPoint(t.center,kn),kn.distanceToSquared(t.center)<=t.radius*t.radius}intersectsPlane(t){let e,n;return t.normal.x>0?(e=t.normal.x*this.min.x,n=t.normal.x*this.max.x):(e=t.normal.x*this.max.x,n=t.normal.x*this.min.x),t.normal.y>0?(e+=t.normal.y*this.min.y,n+=t.normal.y*this.max.y):(e+=t.normal.y*this.max.y,n+=t.normal.y*this.min.y),t.normal.z>0?(e+=t.normal.z*this.min.z,n+=t.normal.z*this.max.z):(e+=t.normal.z*this.max.z,n+=t.normal.z*this.min.z),e<=-t.constant&&n>=-t.constant}intersectsTriangle(t){if(this.isEmpty())return!1;this.getCenter(Tr),ko.subVectors(this.max,Tr),Ps.subVectors(t.a,Tr),Is.subVectors(t.b,Tr),Ls.subVectors(t.c,Tr),Ni.subVectors(Is,Ps),Di.subVectors(Ls,Is),rs.subVectors(Ps,Ls);let e=[0,-Ni.z,Ni.y,0,-Di.z,Di.y,0,-rs.z,rs.y,Ni.z,0,-Ni.x,Di.z,0,-Di.x,rs.z,0,-rs.x,-Ni.y,Ni.x,0,-Di.y,Di.x,0,-rs.y,rs.x,0];return!su(e,Ps,Is,Ls,ko)||(e=[1,0,0,0,1,0,0,0,1],!su(e,Ps,Is,Ls,ko))?!1:(Vo.crossVectors(Ni,Di),e=[Vo.x,Vo.y,Vo.z],su(e,Ps,Is,Ls,ko))}clampPoint(t,e){return e.copy(t).clamp(this.min,this.max)}distanceToPoint(t){return this.clampPoint(t,kn).distanceTo(t)}getBoundingSphere(t){return this.isEmpty()?t.makeEmpty():(this.getCenter(t.center),t.radius=this.getSize(kn).length()*.5),t}intersect(t){return this.min.max(t.min),this.max.min(t.max),this.isEmpty()&&this.makeEmpty(),this}union(t){return this.min.min(t.min),this.max.max(t.max),this}applyMatrix4(t){return this.isEmpty()?this:(di[0].set(this.min.x,this.min.y,this.min.z).applyMatrix4(t),di[1].set(this.min.x,this.min.y,this.max.z).applyMatrix4(t),di[2].set(this.min.x,this.max.y,this.min.z).applyMatrix4(t),di[3].set(this.min.x,this.max.y,this.max.z).applyMatrix4(t),di[4].set(this.max.x,this.min.y,this.min.z).applyMatrix4(t),di[5].set(this.max.x,this.min.y,this.max.z).applyMatrix4(t),di[6].set(this.max.x,this.max.y,this.min.z).applyMatrix4(t),di[7].set(this.max.x,this.max.y,this.max.z).applyMatrix4(t),this.setFromPoints(di),this)}translate(t){return this.min.add(t),this.max.add(t),this}equals(t){return t.min.equals(this.min)&&t.max.equals(this.max)}toJSON(){return{min:this.min.toArray(),max:this.max.toArray()}}fromJSON(t){return this.min.fromArray(t.min),this.max.fromArray(t.max),this}},di=[new N,new N,new N,new N,new N,new N,new N,new N],kn=new N,zo=new _e,Ps=new N,Is=new N,Ls=new N,Ni=new N,Di=new N,rs=new N,Tr=new N,ko=new N,Vo=new N,os=new N;function su(i,t,e,n,s){for(let r=0,o=i.length-3;r<=o;r+=3){os.fromArray(i,r);let l=s.x*Math.abs(os.x)+s.y*Math.abs(os.y)+s.z*Math.abs(os.z),a=t.dot(os),c=e.dot(os),u=n.dot(os);if(Math.max(-Math.max(a,c,u),Math.min(a,c,u))>l)return!1}return!0}var mi=Lg();function Lg(){let i=new ArrayBuffer(4),t=new Float32Array(i),e=new Uint32Array(i),n=new Uint32Array(512),s=new Uint32Array(512);for(let a=0;a<256;++a){let c=a-127;c<-27?(n[a]=0,n[a|256]=32768,s[a]=24,s[a|256]=24):c<-14?(n[a]=1024>>-c-14,n[a|256]=1024>>-c-14|32768,s[a]=-c-1,s[a|256]=-c-1):c<=15?(n[a]=c+15<<10,n[a|256]=c+15<<10|32768,s[a]=13,s[a|256]=13):c<128?(n[a]=31744,n[a|256]=64512,s[a]=24,s[a|256]=24):(n[a]=31744,n[a|256]=64512,s[a]=13,s[a|256]=13)}let r=new Uint32Array(2048),o=new Uint32Array(64),l=new Uint32Array(64);for(let a=1;a<1024;++a){let c=a<<13,u=0;for(;(c&8388608)===0;)c<<=1,u-=8388608;c&=-8388609,u+=947912704,r[a]=c|u}for(let a=1024;a<2048;++a)r[a]=939524096+(a-1024<<13);for(let a=1;a<31;++a)o[a]=a<<23;o[31]=1199570944,o[32]=2147483648;for(let a=33;a<63;++a)o[a]=2147483648+(a-32<<23);o[63]=3347054592;for(let a=1;a<64;++a)a!==32&&(l[a]=1024);return{floatView:t,uint32View:e,baseTable:n,shiftTable:s,mantissaTable:r,exponentTable:o,offsetTable:l}}function Ng(i){Math.abs(i)>65504&&Rt("DataUtils.toHalfFloat(): Value out of range."),i=Bt(i,-65504,65504),mi.floatView[0]=i;let t=mi.uint32View[0],e=t>>23&511;return mi.baseTable[e]+((t&8388607)>>mi.shiftTable[e])}function Dg(i){let t=i>>10;return mi.uint32View[0]=mi.mantissaTable[mi.offsetTable[t]+(i&1023)]+mi.exponentTable[t],mi.floatView[0]}var Or=class{static toHalfFloat(t){return Ng(t)}static fromHalfFloat(t){return Dg(t)}},Re=new N,Go=new Et,Ug=0,Ae=class extends Jn{constructor(t,e,n=!1){if(super(),Array.isArray(t))throw new TypeError("THREE.BufferAttribute: array should be a Typed Array.");this.isBufferAttribute=!0,Object.defineProperty(this,"id",{value:Ug++}),this.name="",this.array=t,this.itemSize=e,this.count=t!==void 0?t.length/e:0,this.normalized=n,this.usage=Nd,this.updateRanges=[],this.gpuType=Hn,this.version=0,this._normalizationScale=t!==void 0?$u(t):void 0}onUploadCallback(){}set needsUpdate(t){t===!0&&this.version++}setUsage(t){return this.usage=t,this}addUpdateRange(t,e){this.updateRanges.push({start:t,count:e})}clearUpdateRanges(){this.updateRanges.length=0}copy(t){return this.name=t.name,this.array=new t.array.constructor(t.array),this.itemSize=t.itemSize,this.count=t.count,this.normalized=t.normalized,this.usage=t.usage,this.gpuType=t.gpuType,this._normalizationScale=t._normalizationScale,this}copyAt(t,e,n){t*=this.itemSize,n*=e.itemSize;for(let s=0,r=this.itemSize;s<r;s++)this.array[t+s]=e.array[n+s];return this}copyArray(t){return this.array.set(t),this}applyMatrix3(t){if(this.itemSize===2)for(let e=0,n=this.count;e<n;e++)Go.fromBufferAttribute(this,e),Go.applyMatrix3(t),this.setXY(e,Go.x,Go.y);else if(this.itemSize===3)for(let e=0,n=this.count;e<n;e++)Re.fromBufferAttribute(this,e),Re.applyMatrix3(t),this.setXYZ(e,Re.x,Re.y,Re.z);return this}applyMatrix4(t){for(let e=0,n=this.count;e<n;e++)Re.fromBufferAttribute(this,e),Re.applyMatrix4(t),this.setXYZ(e,Re.x,Re.y,Re.z);return this}applyNormalMatrix(t){for(let e=0,n=this.count;e<n;e++)Re.fromBufferAttribute(this,e),Re.applyNormalMatrix(t),this.setXYZ(e,Re.x,Re.y,Re.z);return this}transformDirection(t){for(let e=0,n=this.count;e<n;e++)Re.fromBufferAttribute(this,e),Re.transformDirection(t),this.setXYZ(e,Re.x,Re.y,Re.z);return this}set(t,e=0){return this.array.set(t,e),this}getComponent(t,e){let n=this.array[t*this.itemSize+e];return this.normalized&&(n=this._denormalize(n)),n}setComponent(t,e,n){return this.normalized&&(n=this._normalize(n)),this.array[t*this.itemSize+e]=n,this}getX(t){let e=this.array[t*this.itemSize];return this.normalized&&(e=this._denormalize(e)),e}setX(t,e){return this.normalized&&(e=this._normalize(e)),this.array[t*this.itemSize]=e,this}getY(t){let e=this.array[t*this.itemSize+1];return this.normalized&&(e=this._denormalize(e)),e}setY(t,e){return this.normalized&&(e=this._normalize(e)),this.array[t*this.itemSize+1]=e,this}getZ(t){let e=this.array[t*this.itemSize+2];return this.normalized&&(e=this._denormalize(e)),e}setZ(t,e){return this.normalized&&(e=this._normalize(e)),this.array[t*this.itemSize+2]=e,this}getW(t){let e=this.array[t*this.itemSize+3];return this.normalized&&(e=this._denormalize(e)),e}setW(t,e){return this.normalized&&(e=this._normalize(e)),this.array[t*this.itemSize+3]=e,this}setXY(t,e,n){return t*=this.itemSize,this.normalized&&(e=this._normalize(e),n=this._normalize(n)),this.array[t+0]=e,this.array[t+1]=n,this}setXYZ(t,e,n,s){return t*=this.itemSize,this.normalized&&(e=this._normalize(e),n=this._normalize(n),s=this._normalize(s)),this.array[t+0]=e,this.array[t+1]=n,this.array[t+2]=s,this}setXYZW(t,e,n,s,r){return t*=this.itemSize,this.normalized&&(e=this._normalize(e),n=this._normalize(n),s=this._normalize(s),r=this._normalize(r)),this.array[t+0]=e,this.array[t+1]=n,this.array[t+2]=s,this.array[t+3]=r,this}onUpload(t){return this.onUploadCallback=t,this}clone(){return new this.constructor(this.array,this.itemSize).copy(this)}toJSON(){let t={itemSize:this.itemSize,type:this.array.constructor.name,array:Array.from(this.array),normalized:this.normalized};return t.name=this.name,t.usage=this.usage,t.gpuType=this.gpuType,t}dispose(){this.dispatchEvent({type:"dispose"})}_denormalize(t){let e=this._normalizationScale;return e!==void 0?Math.max(t/e,-1):vg(t,this.array)}_normalize(t){let e=this._normalizationScale;return e!==void 0?Math.round(t*e):Mg(t,this.array)}};var Br=class extends Ae{constructor(t,e,n){super(new Uint16Array(t),e,n)}};var zr=class extends Ae{constructor(t,e,n){super(new Uint32Array(t),e,n)}};var We=class extends Ae{constructor(t,e,n){super(new Float32Array(t),e,n)}},Fg=new _e,Er=new N,ru=new N,cs=class{constructor(t=new N,e=-1){this.isSphere=!0,this.center=t,this.radius=e}set(t,e){return this.center.copy(t),this.radius=e,this}setFromPoints(t,e){let n=this.center;e!==void 0?n.copy(e):Fg.setFromPoints(t).getCenter(n);let s=0;for(let r=0,o=t.length;r<o;r++)s=Math.max(s,n.distanceToSquared(t[r]));return this.radius=Math.sqrt(s),this}copy(t){return this.center.copy(t.center),this.radius=t.radius,this}isEmpty(){return this.radius<0}makeEmpty(){return this.center.set(0,0,0),this.radius=-1,this}containsPoint(t){return t.distanceToSquared(this.center)<=this.radius*this.radius}distanceToPoint(t){return t.distanceTo(this.center)-this.radius}intersectsSphere(t){let e=this.radius+t.radius;return t.center.distanceToSquared(this.center)<=e*e}intersectsBox(t){return t.intersectsSphere(this)}intersectsPlane(t){return Math.abs(t.distanceToPoint(this.center))<=this.radius}clampPoint(t,e){let n=this.center.distanceToSquared(t);return e.copy(t),n>this.radius*this.radius&&(e.sub(this.center).normalize(),e.multiplyScalar(this.radius).add(this.center)),e}getBoundingBox(t){return this.isEmpty()?(t.makeEmpty(),t):(t.set(this.center,this.center),t.expandByScalar(this.radius),t)}applyMatrix4(t){return this.center.applyMatrix4(t),this.radius=this.radius*t.getMaxScaleOnAxis(),this}translate(t){return this.center.add(t),this}expandByPoint(t){if(this.isEmpty())return this.center.copy(t),this.radius=0,this;Er.subVectors(t,this.center);let e=Er.lengthSq();if(e>this.radius*this.radius){let n=Math.sqrt(e),s=(n-this.radius)*.5;this.center.addScaledVector(Er,s/n),this.radius+=s}return this}union(t){return t.isEmpty()?this:this.isEmpty()?(this.copy(t),this):(this.center.equals(t.center)===!0?this.radius=Math.max(this.radius,t.radius):(ru.subVectors(t.center,this.center).setLength(t.radius),this.expandByPoint(Er.copy(t.center).add(ru)),this.expandByPoint(Er.copy(t.center).sub(ru))),this)}equals(t){return t.center.equals(this.center)&&t.radius===this.radius}clone(){return new this.constructor().copy(this)}toJSON(){return{radius:this.radius,center:this.center.toArray()}}fromJSON(t){return this.radius=t.radius,this.center.fromArray(t.center),this}},Og=0,Cn=new zt,ou=new yn,Ns=new N,mn=new _e,Rr=new _e,ze=new N,Xe=class i extends Jn{constructor(){super(),this.isBufferGeometry=!0,Object.defineProperty(this,"id",{value:Og++}),this.uuid=io(),this.name="",this.type="BufferGeometry",this.index=null,this.indirect=null,this.indirectOffset=0,this.attributes={},this.morphAttributes={},this.morphTargetsRelative=!1,this.groups=[],this.boundingBox=null,this.boundingSphere=null,this.drawRange={start:0,count:1/0},this.userData={},this._transformed=!1}getIndex(){return this.index}setIndex(t){return Array.isArray(t)?this.index=new(xg(t)?zr:Br)(t,1):this.index=t,this}setIndirect(t,e=0){return this.indirect=t,this.indirectOffset=e,this}getIndirect(){return this.indirect}getAttribute(t){return this.attributes[t]}setAttribute(t,e){return this.attributes[t]=e,this}deleteAttribute(t){return delete this.attributes[t],this}hasAttribute(t){return this.attributes[t]!==void 0}addGroup(t,e,n=0){this.groups.push({start:t,count:e,materialIndex:n})}clearGroups(){this.groups=[]}setDrawRange(t,e){this.drawRange.start=t,this.drawRange.count=e}applyMatrix4(t){let e=this.attributes.position;e!==void 0&&(e.applyMatrix4(t),e.needsUpdate=!0);let n=this.attributes.normal;if(n!==void 0){let r=new Dt().getNormalMatrix(t);n.applyNormalMatrix(r),n.needsUpdate=!0}let s=this.attributes.tangent;return s!==void 0&&(s.transformDirection(t),s.needsUpdate=!0),this.boundingBox!==null&&this.computeBoundingBox(),this.boundingSphere!==null&&this.computeBoundingSphere(),this._transformed=!0,this}applyQuaternion(t){return Cn.makeRotationFromQuaternion(t),this.applyMatrix4(Cn),this}rotateX(t){return Cn.makeRotationX(t),this.applyMatrix4(Cn),this}rotateY(t){return Cn.makeRotationY(t),this.applyMatrix4(Cn),this}rotateZ(t){return Cn.makeRotationZ(t),this.applyMatrix4(Cn),this}translate(t,e,n){return Cn.makeTranslation(t,e,n),this.applyMatrix4(Cn),this}scale(t,e,n){return Cn.makeScale(t,e,n),this.applyMatrix4(Cn),this}lookAt(t){return ou.lookAt(t),ou.updateMatrix(),this.applyMatrix4(ou.matrix),this}center(){return this.computeBoundingBox(),this.boundingBox.getCenter(Ns).negate(),this.translate(Ns.x,Ns.y,Ns.z),this}setFromPoints(t){let e=this.getAttribute("position");if(e===void 0){let n=[];for(let s=0,r=t.length;s<r;s++){let o=t[s];n.push(o.x,o.y,o.z||0)}this.setAttribute("position",new We(n,3))}else{let n=Math.min(t.length,e.count);for(let s=0;s<n;s++){let r=t[s];e.setXYZ(s,r.x,r.y,r.z||0)}t.length>e.count&&Rt("BufferGeometry: Buffer size too small for points data. Use .dispose() and create a new geometry."),e.needsUpdate=!0}return this}computeBoundingBox(){this.boundingBox===null&&(this.boundingBox=new _e);let t=this.attributes.position,e=this.morphAttributes.position;if(t&&t.isGLBufferAttribute){Lt("BufferGeometry.computeBoundingBox(): GLBufferAttribute requires a manual bounding box.",this),this.boundingBox.set(new N(-1/0,-1/0,-1/0),new N(1/0,1/0,1/0));return}if(t!==void 0){if(this.boundingBox.setFromBufferAttribute(t),e)for(let n=0,s=e.length;n<s;n++){let r=e[n];mn.setFromBufferAttribute(r),this.morphTargetsRelative?(ze.addVectors(this.boundingBox.min,mn.min),this.boundingBox.expandByPoint(ze),ze.addVectors(this.boundingBox.max,mn.max),this.boundingBox.expandByPoint(ze)):(this.boundingBox.expandByPoint(mn.min),this.boundingBox.expandByPoint(mn.max))}}else this.boundingBox.makeEmpty();(isNaN(this.boundingBox.min.x)||isNaN(this.boundingBox.min.y)||isNaN(this.boundingBox.min.z))&&Lt('BufferGeometry.computeBoundingBox(): Computed min/max have NaN values. The "position" attribute is likely to have NaN values.',this)}computeBoundingSphere(){this.boundingSphere===null&&(this.boundingSphere=new cs);let t=this.attributes.position,e=this.morphAttributes.position;if(t&&t.isGLBufferAttribute){Lt("BufferGeometry.computeBoundingSphere(): GLBufferAttribute requires a manual bounding sphere.",this),this.boundingSphere.set(new N,1/0);return}if(t){let n=this.boundingSphere.center;if(mn.setFromBufferAttribute(t),e)for(let r=0,o=e.length;r<o;r++){let l=e[r];Rr.setFromBufferAttribute(l),this.morphTargetsRelative?(ze.addVectors(mn.min,Rr.min),mn.expandByPoint(ze),ze.addVectors(mn.max,Rr.max),mn.expandByPoint(ze)):(mn.expandByPoint(Rr.min),mn.expandByPoint(Rr.max))}mn.getCenter(n);let s=0;for(let r=0,o=t.count;r<o;r++)ze.fromBufferAttribute(t,r),s=Math.max(s,n.distanceToSquared(ze));if(e)for(let r=0,o=e.length;r<o;r++){let l=e[r],a=this.morphTargetsRelative;for(let c=0,u=l.count;c<u;c++)ze.fromBufferAttribute(l,c),a&&(Ns.fromBufferAttribute(t,c),ze.add(Ns)),s=Math.max(s,n.distanceToSquared(ze))}this.boundingSphere.radius=Math.sqrt(s),isNaN(this.boundingSphere.radius)&&Lt('BufferGeometry.computeBoundingSphere(): Computed radius is NaN. The "position" attribute is likely to have NaN values.',this)}}computeTangents(){let t=this.index,e=this.attributes;if(t===null||e.position===void 0||e.normal===void 0||e.uv===void 0){Lt("BufferGeometry: .computeTangents() failed. Missing required attributes (index, position, normal or uv)");return}let n=e.position,s=e.normal,r=e.uv,o=this.getAttribute("tangent");(o===void 0||o.count!==n.count)&&(o=new Ae(new Float32Array(4*n.count),4),this.setAttribute("tangent",o));let l=[],a=[],c=new Uint8Array(n.count);for(let L=0;L<n.count;L++)l[L]=new N,a[L]=new N;let u=new N,h=new N,f=new N,d=new Et,g=new Et,y=new Et,p=new N,m=new N;function x(L,E,C){c[L]=c[E]=c[C]=1,u.fromBufferAttribute(n,L),h.fromBufferAttribute(n,E),f.fromBufferAttribute(n,C),d.fromBufferAttribute(r,L),g.fromBufferAttribute(r,E),y.fromBufferAttribute(r,C),h.sub(u),f.sub(u),g.sub(d),y.sub(d);let I=1/(g.x*y.y-y.x*g.y);isFinite(I)&&(p.copy(h).multiplyScalar(y.y).addScaledVector(f,-g.y).multiplyScalar(I),m.copy(f).multiplyScalar(g.x).addScaledVector(h,-y.x).multiplyScalar(I),l[L].add(p),l[E].add(p),l[C].add(p),a[L].add(m),a[E].add(m),a[C].add(m))}let M=this.groups;M.length===0&&(M=[{start:0,count:t.count}]);for(let L=0,E=M.length;L<E;++L){let C=M[L],I=C.start,U=C.count;for(let P=I,B=I+U;P<B;P+=3)x(t.getX(P+0),t.getX(P+1),t.getX(P+2))}let v=new N,S=new N,A=new N,_=new N;function b(L){A.fromBufferAttribute(s,L),_.copy(A);let E=l[L];v.copy(E),v.sub(A.multiplyScalar(A.dot(E))).normalize(),S.crossVectors(_,E);let I=S.dot(a[L])<0?-1:1;o.setXYZW(L,v.x,v.y,v.z,I)}for(let L=0,E=n.count;L<E;++L)c[L]&&b(L);this._transformed=!0}computeVertexNormals(){let t=this.index,e=this.getAttribute("position");if(e!==void 0){let n=this.getAttribute("normal");if(n===void 0||n.count!==e.count)n=new Ae(new Float32Array(e.count*3),3),this.setAttribute("normal",n);else for(let f=0,d=n.count;f<d;f++)n.setXYZ(f,0,0,0);let s=new N,r=new N,o=new N,l=new N,a=new N,c=new N,u=new N,h=new N;if(t)for(let f=0,d=t.count;f<d;f+=3){let g=t.getX(f+0),y=t.getX(f+1),p=t.getX(f+2);s.fromBufferAttribute(e,g),r.fromBufferAttribute(e,y),o.fromBufferAttribute(e,p),u.subVectors(o,r),h.subVectors(s,r),u.cross(h),l.fromBufferAttribute(n,g),a.fromBufferAttribute(n,y),c.fromBufferAttribute(n,p),l.add(u),a.add(u),c.add(u),n.setXYZ(g,l.x,l.y,l.z),n.setXYZ(y,a.x,a.y,a.z),n.setXYZ(p,c.x,c.y,c.z)}else for(let f=0,d=e.count;f<d;f+=3)s.fromBufferAttribute(e,f+0),r.fromBufferAttribute(e,f+1),o.fromBufferAttribute(e,f+2),u.subVectors(o,r),h.subVectors(s,r),u.cross(h),n.setXYZ(f+0,u.x,u.y,u.z),n.setXYZ(f+1,u.x,u.y,u.z),n.setXYZ(f+2,u.x,u.y,u.z);this.normalizeNormals(),n.needsUpdate=!0}}normalizeNormals(){let t=this.attributes.normal;for(let e=0,n=t.count;e<n;e++)ze.fromBufferAttribute(t,e),ze.normalize(),t.setXYZ(e,ze.x,ze.y,ze.z)}toNonIndexed(){function t(l,a){let c=l.array,u=l.itemSize,h=l.normalized,f=new c.constructor(a.length*u),d=0,g=0;for(let y=0,p=a.length;y<p;y++){l.isInterleavedBufferAttribute?d=a[y]*l.data.stride+l.offset:d=a[y]*u;for(let m=0;m<u;m++)f[g++]=c[d++]}return new Ae(f,u,h)}if(this.index===null)return Rt("BufferGeometry.toNonIndexed(): BufferGeometry is already non-indexed."),this;let e=new i,n=this.index.array,s=this.attributes;for(let l in s){let a=s[l],c=t(a,n);e.setAttribute(l,c)}let r=this.morphAttributes;for(let l in r){let a=[],c=r[l];for(let u=0,h=c.length;u<h;u++){let f=c[u],d=t(f,n);a.push(d)}e.morphAttributes[l]=a}e.morphTargetsRelative=this.morphTargetsRelative;let o=this.groups;for(let l=0,a=o.length;l<a;l++){let c=o[l];e.addGroup(c.start,c.count,c.materialIndex)}return e}toJSON(){let t={metadata:{version:4.7,type:"BufferGeometry",generator:"BufferGeometry.toJSON"}};if(t.uuid=this.uuid,t.type=this.parameters!==void 0&&this._transformed===!0?"BufferGeometry":this.type,t.name=this.name,Object.keys(this.userData).length>0&&(t.userData=this.userData),this.parameters!==void 0&&this._transformed!==!0){let a=this.parameters;for(let c in a)a[c]!==void 0&&(t[c]=a[c]);return t}t.data={attributes:{}};let e=this.index;e!==null&&(t.data.index={type:e.array.constructor.name,array:Array.prototype.slice.call(e.array)});let n=this.attributes;for(let a in n){let c=n[a];t.data.attributes[a]=c.toJSON(t.data)}let s={},r=!1;for(let a in this.morphAttributes){let c=this.morphAttributes[a],u=[];for(let h=0,f=c.length;h<f;h++){let d=c[h];u.push(d.toJSON(t.data))}u.length>0&&(s[a]=u,r=!0)}r&&(t.data.morphAttributes=s,t.data.morphTargetsRelative=this.morphTargetsRelative);let o=this.groups;o.length>0&&(t.data.groups=JSON.parse(JSON.stringify(o)));let l=this.boundingSphere;return l!==null&&(t.data.boundingSphere=l.toJSON()),t}clone(){return new this.constructor().copy(this)}copy(t){this.index=null,this.attributes={},this.morphAttributes={},this.groups=[],this.boundingBox=null,this.boundingSphere=null;let e={};this.name=t.name;let n=t.index;n!==null&&this.setIndex(n.clone());let s=t.attributes;for(let c in s){let u=s[c];this.setAttribute(c,u.clone(e))}let r=t.morphAttributes;for(let c in r){let u=[],h=r[c];for(let f=0,d=h.length;f<d;f++)u.push(h[f].clone(e));this.morphAttributes[c]=u}this.morphTargetsRelative=t.morphTargetsRelative;let o=t.groups;for(let c=0,u=o.length;c<u;c++){let h=o[c];this.addGroup(h.start,h.count,h.materialIndex)}let l=t.boundingBox;l!==null&&(this.boundingBox=l.clone());let a=t.boundingSphere;return a!==null&&(this.boundingSphere=a.clone()),this.drawRange.start=t.drawRange.start,this.drawRange.count=t.drawRange.count,this.userData=t.userData,this._transformed=t._transformed,this}dispose(){this.dispatchEvent({type:"dispose"})}};var au=new N,Bg=new N,zg=new Dt,sn=class{constructor(t=new N(1,0,0),e=0){this.isPlane=!0,this.normal=t,this.constant=e}set(t,e){return this.normal.copy(t),this.constant=e,this}setComponents(t,e,n,s){return this.normal.set(t,e,n),this.constant=s,this}setFromNormalAndCoplanarPoint(t,e){return this.normal.copy(t),this.constant=-e.dot(this.normal),this}setFromCoplanarPoints(t,e,n){let s=au.subVectors(n,e).cross(Bg.subVectors(t,e)).normalize();return this.setFromNormalAndCoplanarPoint(s,t),this}copy(t){return this.normal.copy(t.normal),this.constant=t.constant,this}normalize(){let t=1/this.normal.length();return this.normal.multiplyScalar(t),this.constant*=t,this}negate(){return this.constant*=-1,this.normal.negate(),this}distanceToPoint(t){return this.normal.dot(t)+this.constant}distanceToSphere(t){return this.distanceToPoint(t.center)-t.radius}projectPoint(t,e){return e.copy(t).addScaledVector(this.normal,-this.distanceToPoint(t))}intersectLine(t,e,n=!0){let s=t.delta(au),r=this.normal.dot(s);if(r===0)return this.distanceToPoint(t.start)===0?e.copy(t.start):null;let o=-(t.start.dot(this.normal)+this.constant)/r;return n===!0&&(o<0||o>1)?null:e.copy(t.start).addScaledVector(s,o)}intersectsLine(t){let e=this.distanceToPoint(t.start),n=this.distanceToPoint(t.end);return e<0&&n>0||n<0&&e>0}intersectsBox(t){return t.intersectsPlane(this)}intersectsSphere(t){return t.intersectsPlane(this)}coplanarPoint(t){return t.copy(this.normal).multiplyScalar(-this.constant)}applyMatrix4(t,e){let n=e||zg.getNormalMatrix(t),s=this.coplanarPoint(au).applyMatrix4(t),r=this.normal.applyMatrix3(n).normalize();return this.constant=-s.dot(r),this}translate(t){return this.constant-=t.dot(this.normal),this}equals(t){return t.normal.equals(this.normal)&&t.constant===this.constant}clone(){return new this.constructor().copy(this)}toJSON(){return{normal:this.normal.toArray(),constant:this.constant}}fromJSON(t){return this.normal.fromArray(t.normal),this.constant=t.constant,this}},kg=0,Bi=class extends Jn{constructor(){super(),this.isMaterial=!0,Object.defineProperty(this,"id",{value:kg++}),this.uuid=io(),this.name="",this.type="Material",this.blending=Js,this.side=Vn,this.vertexColors=!1,this.opacity=1,this.transparent=!1,this.alphaHash=!1,this.blendSrc=bu,this.blendDst=wu,this.blendEquation=fs,this.blendSrcAlpha=null,this.blendDstAlpha=null,this.blendEquationAlpha=null,this.blendColor=new Zt(0,0,0),this.blendAlpha=0,this.depthFunc=ks,this.depthTest=!0,this.depthWrite=!0,this.stencilWriteMask=255,this.stencilFunc=Al,this.stencilRef=0,this.stencilFuncMask=255,this.stencilFail=oa,this.stencilZFail=oa,this.stencilZPass=oa,this.stencilWrite=!1,this.clippingPlanes=null,this.clipIntersection=!1,this.clipShadows=!1,this.shadowSide=null,this.colorWrite=!0,this.precision=null,this.polygonOffset=!1,this.polygonOffsetFactor=0,this.polygonOffsetUnits=0,this.dithering=!1,this.alphaToCoverage=!1,this.premultipliedAlpha=!1,this.forceSinglePass=!1,this.allowOverride=!0,this.visible=!0,this.toneMapped=!0,this.userData={},this.version=0,this._alphaTest=0}get alphaTest(){return this._alphaTest}set alphaTest(t){this._alphaTest>0!=t>0&&this.version++,this._alphaTest=t}onBeforeRender(){}onBeforeCompile(){}customProgramCacheKey(){return this.onBeforeCompile.toString()}setValues(t){if(t!==void 0)for(let e in t){let n=t[e];if(n===void 0){Rt(`Material: parameter '${e}' has value of undefined.`);continue}let s=this[e];if(s===void 0){Rt(`Material: '${e}' is not a property of THREE.${this.type}.`);continue}s&&s.isColor?s.set(n):s&&s.isVector2&&n&&n.isVector2||s&&s.isEuler&&n&&n.isEuler||s&&s.isVector3&&n&&n.isVector3?s.copy(n):this[e]=n}}toJSON(t){let e=t===void 0||typeof t=="string";e&&(t={textures:{},images:{}});let n={metadata:{version:4.7,type:"Material",generator:"Material.toJSON"}};n.uuid=this.uuid,n.type=this.type,n.blending=this.blending,n.side=this.side,n.shadowSide=this.shadowSide,n.vertexColors=this.vertexColors,n.opacity=this.opacity,n.transparent=this.transparent,n.blendSrc=this.blendSrc,n.blendDst=this.blendDst,n.blendEquation=this.blendEquation,n.blendSrcAlpha=this.blendSrcAlpha,n.blendDstAlpha=this.blendDstAlpha,n.blendEquationAlpha=this.blendEquationAlpha,n.blendColor=this.blendColor.getHex(),n.blendAlpha=this.blendAlpha,n.depthFunc=this.depthFunc,n.depthTest=this.depthTest,n.depthWrite=this.depthWrite,n.colorWrite=this.colorWrite,n.clipIntersection=this.clipIntersection,n.clipShadows=this.clipShadows,n.stencilWriteMask=this.stencilWriteMask,n.stencilFunc=this.stencilFunc,n.stencilRef=this.stencilRef,n.stencilFuncMask=this.stencilFuncMask,n.stencilFail=this.stencilFail,n.stencilZFail=this.stencilZFail,n.stencilZPass=this.stencilZPass,n.stencilWrite=this.stencilWrite,n.polygonOffset=this.polygonOffset,n.polygonOffsetFactor=this.polygonOffsetFactor,n.polygonOffsetUnits=this.polygonOffsetUnits,n.dithering=this.dithering,n.alphaTest=this.alphaTest,n.alphaHash=this.alphaHash,n.alphaToCoverage=this.alphaToCoverage,n.premultipliedAlpha=this.premultipliedAlpha,n.forceSinglePass=this.forceSinglePass,n.allowOverride=this.allowOverride,n.visible=this.visible,n.toneMapped=this.toneMapped,n.name=this.name,this.color&&this.color.isColor&&(n.color=this.color.getHex()),this.roughness!==void 0&&(n.roughness=this.roughness),this.metalness!==void 0&&(n.metalness=this.metalness),this.sheen!==void 0&&(n.sheen=this.sheen),this.sheenColor&&this.sheenColor.isColor&&(n.sheenColor=this.sheenColor.getHex()),this.sheenRoughness!==void 0&&(n.sheenRoughness=this.sheenRoughness),this.emissive&&this.emissive.isColor&&(n.emissive=this.emissive.getHex()),this.emissiveIntensity!==void 0&&(n.emissiveIntensity=this.emissiveIntensity),this.specular&&this.specular.isColor&&(n.specular=this.specular.getHex()),this.specularIntensity!==void 0&&(n.specularIntensity=this.specularIntensity),this.specularColor&&this.specularColor.isColor&&(n.specularColor=this.specularColor.getHex()),this.shininess!==void 0&&(n.shininess=this.shininess),this.clearcoat!==void 0&&(n.clearcoat=this.clearcoat),this.clearcoatRoughness!==void 0&&(n.clearcoatRoughness=this.clearcoatRoughness),this.diffuseRoughness!==void 0&&(n.diffuseRoughness=this.diffuseRoughness),this.diffuseRoughnessMap&&this.diffuseRoughnessMap.isTexture&&(n.diffuseRoughnessMap=this.diffuseRoughnessMap.toJSON(t).uuid),this.clearcoatMap&&this.clearcoatMap.isTexture&&(n.clearcoatMap=this.clearcoatMap.toJSON(t).uuid),this.clearcoatRoughnessMap&&this.clearcoatRoughnessMap.isTexture&&(n.clearcoatRoughnessMap=this.clearcoatRoughnessMap.toJSON(t).uuid),this.clearcoatNormalMap&&this.clearcoatNormalMap.isTexture&&(n.clearcoatNormalMap=this.clearcoatNormalMap.toJSON(t).uuid,n.clearcoatNormalScale=this.clearcoatNormalScale.toArray()),this.sheenColorMap&&this.sheenColorMap.isTexture&&(n.sheenColorMap=this.sheenColorMap.toJSON(t).uuid),this.sheenRoughnessMap&&this.sheenRoughnessMap.isTexture&&(n.sheenRoughnessMap=this.sheenRoughnessMap.toJSON(t).uuid),this.dispersion!==void 0&&(n.dispersion=this.dispersion),this.retroreflectivity!==void 0&&(n.retroreflectivity=this.retroreflectivity),this.iridescence!==void 0&&(n.iridescence=this.iridescence),this.iridescenceIOR!==void 0&&(n.iridescenceIOR=this.iridescenceIOR),this.iridescenceThicknessMinimum!==void 0&&(n.iridescenceThicknessMinimum=this.iridescenceThicknessMinimum),this.iridescenceThicknessMaximum!==void 0&&(n.iridescenceThicknessMaximum=this.iridescenceThicknessMaximum),this.iridescenceMap&&this.iridescenceMap.isTexture&&(n.iridescenceMap=this.iridescenceMap.toJSON(t).uuid),this.iridescenceThicknessMap&&this.iridescenceThicknessMap.isTexture&&(n.iridescenceThicknessMap=this.iridescenceThicknessMap.toJSON(t).uuid),this.anisotropy!==void 0&&(n.anisotropy=this.anisotropy),this.anisotropyRotation!==void 0&&(n.anisotropyRotation=this.anisotropyRotation),this.anisotropyMap&&this.anisotropyMap.isTexture&&(n.anisotropyMap=this.anisotropyMap.toJSON(t).uuid),this.map&&this.map.isTexture&&(n.map=this.map.toJSON(t).uuid),this.matcap&&this.matcap.isTexture&&(n.matcap=this.matcap.toJSON(t).uuid),this.alphaMap&&this.alphaMap.isTexture&&(n.alphaMap=this.alphaMap.toJSON(t).uuid),this.lightMap&&this.lightMap.isTexture&&(n.lightMap=this.lightMap.toJSON(t).uuid,n.lightMapIntensity=this.lightMapIntensity),this.aoMap&&this.aoMap.isTexture&&(n.aoMap=this.aoMap.toJSON(t).uuid,n.aoMapIntensity=this.aoMapIntensity),this.bumpMap&&this.bumpMap.isTexture&&(n.bumpMap=this.bumpMap.toJSON(t).uuid,n.bumpScale=this.bumpScale),this.normalMap&&this.normalMap.isTexture&&(n.normalMap=this.normalMap.toJSON(t).uuid,n.normalMapType=this.normalMapType,n.normalScale=this.normalScale.toArray()),this.displacementMap&&this.displacementMap.isTexture&&(n.displacementMap=this.displacementMap.toJSON(t).uuid,n.displacementScale=this.displacementScale,n.displacementBias=this.displacementBias),this.roughnessMap&&this.roughnessMap.isTexture&&(n.roughnessMap=this.roughnessMap.toJSON(t).uuid),this.metalnessMap&&this.metalnessMap.isTexture&&(n.metalnessMap=this.metalnessMap.toJSON(t).uuid),this.emissiveMap&&this.emissiveMap.isTexture&&(n.emissiveMap=this.emissiveMap.toJSON(t).uuid),this.specularMap&&this.specularMap.isTexture&&(n.specularMap=this.specularMap.toJSON(t).uuid),this.specularIntensityMap&&this.specularIntensityMap.isTexture&&(n.specularIntensityMap=this.specularIntensityMap.toJSON(t).uuid),this.specularColorMap&&this.specularColorMap.isTexture&&(n.specularColorMap=this.specularColorMap.toJSON(t).uuid),this.envMap&&this.envMap.isTexture&&(n.envMap=this.envMap.toJSON(t).uuid,this.combine!==void 0&&(n.combine=this.combine)),this.envMapRotation!==void 0&&(n.envMapRotation=this.envMapRotation.toArray()),this.envMapIntensity!==void 0&&(n.envMapIntensity=this.envMapIntensity),this.reflectivity!==void 0&&(n.reflectivity=this.reflectivity),this.refractionRatio!==void 0&&(n.refractionRatio=this.refractionRatio),this.gradientMap&&this.gradientMap.isTexture&&(n.gradientMap=this.gradientMap.toJSON(t).uuid),this.transmission!==void 0&&(n.transmission=this.transmission),this.transmissionMap&&this.transmissionMap.isTexture&&(n.transmissionMap=this.transmissionMap.toJSON(t).uuid),this.thickness!==void 0&&(n.thickness=this.thickness),this.thicknessMap&&this.thicknessMap.isTexture&&(n.thicknessMap=this.thicknessMap.toJSON(t).uuid),this.attenuationDistance!==void 0&&(n.attenuationDistance=this.attenuationDistance),this.attenuationColor!==void 0&&(n.attenuationColor=this.attenuationColor.getHex()),this.size!==void 0&&(n.size=this.size),this.sizeAttenuation!==void 0&&(n.sizeAttenuation=this.sizeAttenuation),Array.isArray(this.clippingPlanes)&&this.clippingPlanes.length>0&&(n.clippingPlanes=this.clippingPlanes.map(r=>r.toJSON())),this.rotation!==void 0&&(n.rotation=this.rotation),this.depthPacking!==void 0&&(n.depthPacking=this.depthPacking),this.linewidth!==void 0&&(n.linewidth=this.linewidth),this.linecap!==void 0&&(n.linecap=this.linecap),this.linejoin!==void 0&&(n.linejoin=this.linejoin),this.dashSize!==void 0&&(n.dashSize=this.dashSize),this.gapSize!==void 0&&(n.gapSize=this.gapSize),this.scale!==void 0&&(n.scale=this.scale),this.wireframe!==void 0&&(n.wireframe=this.wireframe),this.wireframeLinewidth!==void 0&&(n.wireframeLinewidth=this.wireframeLinewidth),this.wireframeLinecap!==void 0&&(n.wireframeLinecap=this.wireframeLinecap),this.wireframeLinejoin!==void 0&&(n.wireframeLinejoin=this.wireframeLinejoin),this.flatShading!==void 0&&(n.flatShading=this.flatShading),this.fog!==void 0&&(n.fog=this.fog),Object.keys(this.userData).length>0&&(n.userData=this.userData);function s(r){let o=[];for(let l in r){let a=r[l];delete a.metadata,o.push(a)}return o}if(e){let r=s(t.textures),o=s(t.images);r.length>0&&(n.textures=r),o.length>0&&(n.images=o)}return n}fromJSON(t,e){if(t.uuid!==void 0&&(this.uuid=t.uuid),t.name!==void 0&&(this.name=t.name),t.color!==void 0&&this.color!==void 0&&this.color.setHex(t.color),t.roughness!==void 0&&(this.roughness=t.roughness),t.metalness!==void 0&&(this.metalness=t.metalness),t.sheen!==void 0&&(this.sheen=t.sheen),t.sheenColor!==void 0&&(this.sheenColor=new Zt().setHex(t.sheenColor)),t.sheenRoughness!==void 0&&(this.sheenRoughness=t.sheenRoughness),t.emissive!==void 0&&this.emissive!==void 0&&this.emissive.setHex(t.emissive),t.specular!==void 0&&this.specular!==void 0&&this.specular.setHex(t.specular),t.specularIntensity!==void 0&&(this.specularIntensity=t.specularIntensity),t.specularColor!==void 0&&this.specularColor!==void 0&&this.specularColor.setHex(t.specularColor),t.shininess!==void 0&&(this.shininess=t.shininess),t.clearcoat!==void 0&&(this.clearcoat=t.clearcoat),t.clearcoatRoughness!==void 0&&(this.clearcoatRoughness=t.clearcoatRoughness),t.diffuseRoughness!==void 0&&(this.diffuseRoughness=t.diffuseRoughness),t.dispersion!==void 0&&(this.dispersion=t.dispersion),t.retroreflectivity!==void 0&&(this.retroreflectivity=t.retroreflectivity),t.iridescence!==void 0&&(this.iridescence=t.iridescence),t.iridescenceIOR!==void 0&&(this.iridescenceIOR=t.iridescenceIOR),t.iridescenceThicknessMinimum!==void 0&&(this.iridescenceThicknessMinimum=t.iridescenceThicknessMinimum),t.iridescenceThicknessMaximum!==void 0&&(this.iridescenceThicknessMaximum=t.iridescenceThicknessMaximum),t.iridescenceThicknessRange!==void 0&&(this.iridescenceThicknessMinimum=t.iridescenceThicknessRange[0],this.iridescenceThicknessMaximum=t.iridescenceThicknessRange[1]),t.transmission!==void 0&&(this.transmission=t.transmission),t.thickness!==void 0&&(this.thickness=t.thickness),t.attenuationDistance!==void 0&&(this.attenuationDistance=t.attenuationDistance),t.attenuationColor!==void 0&&this.attenuationColor!==void 0&&this.attenuationColor.setHex(t.attenuationColor),t.anisotropy!==void 0&&(this.anisotropy=t.anisotropy),t.anisotropyRotation!==void 0&&(this.anisotropyRotation=t.anisotropyRotation),t.fog!==void 0&&(this.fog=t.fog),t.flatShading!==void 0&&(this.flatShading=t.flatShading),t.blending!==void 0&&(this.blending=t.blending),t.combine!==void 0&&(this.combine=t.combine),t.side!==void 0&&(this.side=t.side),t.shadowSide!==void 0&&(this.shadowSide=t.shadowSide),t.opacity!==void 0&&(this.opacity=t.opacity),t.transparent!==void 0&&(this.transparent=t.transparent),t.alphaTest!==void 0&&(this.alphaTest=t.alphaTest),t.alphaHash!==void 0&&(this.alphaHash=t.alphaHash),t.depthFunc!==void 0&&(this.depthFunc=t.depthFunc),t.depthTest!==void 0&&(this.depthTest=t.depthTest),t.depthWrite!==void 0&&(this.depthWrite=t.depthWrite),t.colorWrite!==void 0&&(this.colorWrite=t.colorWrite),t.clippingPlanes!==void 0&&(this.clippingPlanes=t.clippingPlanes.map(n=>new sn().fromJSON(n))),t.clipIntersection!==void 0&&(this.clipIntersection=t.clipIntersection),t.clipShadows!==void 0&&(this.clipShadows=t.clipShadows),t.depthPacking!==void 0&&(this.depthPacking=t.depthPacking),t.blendSrc!==void 0&&(this.blendSrc=t.blendSrc),t.blendDst!==void 0&&(this.blendDst=t.blendDst),t.blendEquation!==void 0&&(this.blendEquation=t.blendEquation),t.blendSrcAlpha!==void 0&&(this.blendSrcAlpha=t.blendSrcAlpha),t.blendDstAlpha!==void 0&&(this.blendDstAlpha=t.blendDstAlpha),t.blendEquationAlpha!==void 0&&(this.blendEquationAlpha=t.blendEquationAlpha),t.blendColor!==void 0&&this.blendColor!==void 0&&this.blendColor.setHex(t.blendColor),t.blendAlpha!==void 0&&(this.blendAlpha=t.blendAlpha),t.stencilWriteMask!==void 0&&(this.stencilWriteMask=t.stencilWriteMask),t.stencilFunc!==void 0&&(this.stencilFunc=t.stencilFunc),t.stencilRef!==void 0&&(this.stencilRef=t.stencilRef),t.stencilFuncMask!==void 0&&(this.stencilFuncMask=t.stencilFuncMask),t.stencilFail!==void 0&&(this.stencilFail=t.stencilFail),t.stencilZFail!==void 0&&(this.stencilZFail=t.stencilZFail),t.stencilZPass!==void 0&&(this.stencilZPass=t.stencilZPass),t.stencilWrite!==void 0&&(this.stencilWrite=t.stencilWrite),t.wireframe!==void 0&&(this.wireframe=t.wireframe),t.wireframeLinewidth!==void 0&&(this.wireframeLinewidth=t.wireframeLinewidth),t.wireframeLinecap!==void 0&&(this.wireframeLinecap=t.wireframeLinecap),t.wireframeLinejoin!==void 0&&(this.wireframeLinejoin=t.wireframeLinejoin),t.rotation!==void 0&&(this.rotation=t.rotation),t.linewidth!==void 0&&(this.linewidth=t.linewidth),t.linecap!==void 0&&(this.linecap=t.linecap),t.linejoin!==void 0&&(this.linejoin=t.linejoin),t.dashSize!==void 0&&(this.dashSize=t.dashSize),t.gapSize!==void 0&&(this.gapSize=t.gapSize),t.scale!==void 0&&(this.scale=t.scale),t.polygonOffset!==void 0&&(this.polygonOffset=t.polygonOffset),t.polygonOffsetFactor!==void 0&&(this.polygonOffsetFactor=t.polygonOffsetFactor),t.polygonOffsetUnits!==void 0&&(this.polygonOffsetUnits=t.polygonOffsetUnits),t.dithering!==void 0&&(this.dithering=t.dithering),t.alphaToCoverage!==void 0&&(this.alphaToCoverage=t.alphaToCoverage),t.premultipliedAlpha!==void 0&&(this.premultipliedAlpha=t.premultipliedAlpha),t.forceSinglePass!==void 0&&(this.forceSinglePass=t.forceSinglePass),t.allowOverride!==void 0&&(this.allowOverride=t.allowOverride),t.visible!==void 0&&(this.visible=t.visible),t.toneMapped!==void 0&&(this.toneMapped=t.toneMapped),t.userData!==void 0&&(this.userData=t.userData),t.vertexColors!==void 0&&(typeof t.vertexColors=="number"?this.vertexColors=t.vertexColors>0:this.vertexColors=t.vertexColors),t.size!==void 0&&(this.size=t.size),t.sizeAttenuation!==void 0&&(this.sizeAttenuation=t.sizeAttenuation),t.map!==void 0&&(this.map=e[t.map]||null),t.matcap!==void 0&&(this.matcap=e[t.matcap]||null),t.alphaMap!==void 0&&(this.alphaMap=e[t.alphaMap]||null),t.bumpMap!==void 0&&(this.bumpMap=e[t.bumpMap]||null),t.bumpScale!==void 0&&(this.bumpScale=t.bumpScale),t.normalMap!==void 0&&(this.normalMap=e[t.normalMap]||null),t.normalMapType!==void 0&&(this.normalMapType=t.normalMapType),t.normalScale!==void 0){let n=t.normalScale;Array.isArray(n)===!1&&(n=[n,n]),this.normalScale=new Et().fromArray(n)}return t.displacementMap!==void 0&&(this.displacementMap=e[t.displacementMap]||null),t.displacementScale!==void 0&&(this.displacementScale=t.displacementScale),t.displacementBias!==void 0&&(this.displacementBias=t.displacementBias),t.roughnessMap!==void 0&&(this.roughnessMap=e[t.roughnessMap]||null),t.metalnessMap!==void 0&&(this.metalnessMap=e[t.metalnessMap]||null),t.emissiveMap!==void 0&&(this.emissiveMap=e[t.emissiveMap]||null),t.emissiveIntensity!==void 0&&(this.emissiveIntensity=t.emissiveIntensity),t.specularMap!==void 0&&(this.specularMap=e[t.specularMap]||null),t.specularIntensityMap!==void 0&&(this.specularIntensityMap=e[t.specularIntensityMap]||null),t.specularColorMap!==void 0&&(this.specularColorMap=e[t.specularColorMap]||null),t.envMap!==void 0&&(this.envMap=e[t.envMap]||null),t.envMapRotation!==void 0&&this.envMapRotation.fromArray(t.envMapRotation),t.envMapIntensity!==void 0&&(this.envMapIntensity=t.envMapIntensity),t.reflectivity!==void 0&&(this.reflectivity=t.reflectivity),t.refractionRatio!==void 0&&(this.refractionRatio=t.refractionRatio),t.lightMap!==void 0&&(this.lightMap=e[t.lightMap]||null),t.lightMapIntensity!==void 0&&(this.lightMapIntensity=t.lightMapIntensity),t.aoMap!==void 0&&(this.aoMap=e[t.aoMap]||null),t.aoMapIntensity!==void 0&&(this.aoMapIntensity=t.aoMapIntensity),t.gradientMap!==void 0&&(this.gradientMap=e[t.gradientMap]||null),t.clearcoatMap!==void 0&&(this.clearcoatMap=e[t.clearcoatMap]||null),t.clearcoatRoughnessMap!==void 0&&(this.clearcoatRoughnessMap=e[t.clearcoatRoughnessMap]||null),t.clearcoatNormalMap!==void 0&&(this.clearcoatNormalMap=e[t.clearcoatNormalMap]||null),t.clearcoatNormalScale!==void 0&&(this.clearcoatNormalScale=new Et().fromArray(t.clearcoatNormalScale)),t.diffuseRoughnessMap!==void 0&&(this.diffuseRoughnessMap=e[t.diffuseRoughnessMap]||null),t.iridescenceMap!==void 0&&(this.iridescenceMap=e[t.iridescenceMap]||null),t.iridescenceThicknessMap!==void 0&&(this.iridescenceThicknessMap=e[t.iridescenceThicknessMap]||null),t.transmissionMap!==void 0&&(this.transmissionMap=e[t.transmissionMap]||null),t.thicknessMap!==void 0&&(this.thicknessMap=e[t.thicknessMap]||null),t.anisotropyMap!==void 0&&(this.anisotropyMap=e[t.anisotropyMap]||null),t.sheenColorMap!==void 0&&(this.sheenColorMap=e[t.sheenColorMap]||null),t.sheenRoughnessMap!==void 0&&(this.sheenRoughnessMap=e[t.sheenRoughnessMap]||null),this}clone(){return new this.constructor().copy(this)}copy(t){this.name=t.name,this.blending=t.blending,this.side=t.side,this.vertexColors=t.vertexColors,this.opacity=t.opacity,this.transparent=t.transparent,this.blendSrc=t.blendSrc,this.blendDst=t.blendDst,this.blendEquation=t.blendEquation,this.blendSrcAlpha=t.blendSrcAlpha,this.blendDstAlpha=t.blendDstAlpha,this.blendEquationAlpha=t.blendEquationAlpha,this.blendColor.copy(t.blendColor),this.blendAlpha=t.blendAlpha,this.depthFunc=t.depthFunc,this.depthTest=t.depthTest,this.depthWrite=t.depthWrite,this.stencilWriteMask=t.stencilWriteMask,this.stencilFunc=t.stencilFunc,this.stencilRef=t.stencilRef,this.stencilFuncMask=t.stencilFuncMask,this.stencilFail=t.stencilFail,this.stencilZFail=t.stencilZFail,this.stencilZPass=t.stencilZPass,this.stencilWrite=t.stencilWrite;let e=t.clippingPlanes,n=null;if(e!==null){let s=e.length;n=new Array(s);for(let r=0;r!==s;++r)n[r]=e[r].clone()}return this.clippingPlanes=n,this.clipIntersection=t.clipIntersection,this.clipShadows=t.clipShadows,this.shadowSide=t.shadowSide,this.colorWrite=t.colorWrite,this.precision=t.precision,this.polygonOffset=t.polygonOffset,this.polygonOffsetFactor=t.polygonOffsetFactor,this.polygonOffsetUnits=t.polygonOffsetUnits,this.dithering=t.dithering,this.alphaTest=t.alphaTest,this.alphaHash=t.alphaHash,this.alphaToCoverage=t.alphaToCoverage,this.premultipliedAlpha=t.premultipliedAlpha,this.forceSinglePass=t.forceSinglePass,this.allowOverride=t.allowOverride,this.visible=t.visible,this.toneMapped=t.toneMapped,this.userData=JSON.parse(JSON.stringify(t.userData)),this}dispose(){this.dispatchEvent({type:"dispose"})}set needsUpdate(t){t===!0&&this.version++}};var pi=new N,lu=new N,Ho=new N,Wo=new N,In=class{constructor(t=new N,e=new N(0,0,-1)){this.origin=t,this.direction=e}set(t,e){return this.origin.copy(t),this.direction.copy(e),this}copy(t){return this.origin.copy(t.origin),this.direction.copy(t.direction),this}at(t,e){return e.copy(this.origin).addScaledVector(this.direction,t)}lookAt(t){return this.direction.copy(t).sub(this.origin).normalize(),this}recast(t){return this.origin.copy(this.at(t,pi)),this}closestPointToPoint(t,e){e.subVectors(t,this.origin);let n=e.dot(this.direction);return n<0?e.copy(this.origin):e.copy(this.origin).addScaledVector(this.direction,n)}distanceToPoint(t){return Math.sqrt(this.distanceSqToPoint(t))}distanceSqToPoint(t){let e=pi.subVectors(t,this.origin).dot(this.direction);return e<0?this.origin.distanceToSquared(t):(pi.copy(this.origin).addScaledVector(this.direction,e),pi.distanceToSquared(t))}distanceSqToSegment(t,e,n,s){lu.copy(t).add(e).multiplyScalar(.5),Ho.copy(e).sub(t).normalize(),Wo.copy(this.origin).sub(lu);let r=t.distanceTo(e)*.5,o=-this.direction.dot(Ho),l=Wo.dot(this.direction),a=-Wo.dot(Ho),c=Wo.lengthSq(),u=Math.abs(1-o*o),h,f,d,g;if(u>0)if(h=o*a-l,f=o*l-a,g=r*u,h>=0)if(f>=-g)if(f<=g){let y=1/u;h*=y,f*=y,d=h*(h+o*f+2*l)+f*(o*h+f+2*a)+c}else f=r,h=Math.max(0,-(o*f+l)),d=-h*h+f*(f+2*a)+c;else f=-r,h=Math.max(0,-(o*f+l)),d=-h*h+f*(f+2*a)+c;else f<=-g?(h=Math.max(0,-(-o*r+l)),f=h>0?-r:Math.min(Math.max(-r,-a),r),d=-h*h+f*(f+2*a)+c):f<=g?(h=0,f=Math.min(Math.max(-r,-a),r),d=f*(f+2*a)+c):(h=Math.max(0,-(o*r+l)),f=h>0?r:Math.min(Math.max(-r,-a),r),d=-h*h+f*(f+2*a)+c);else f=o>0?-r:r,h=Math.max(0,-(o*f+l)),d=-h*h+f*(f+2*a)+c;return n&&n.copy(this.origin).addScaledVector(this.direction,h),s&&s.copy(lu).addScaledVector(Ho,f),d}intersectSphere(t,e){if(t.radius<0)return null;pi.subVectors(t.center,this.origin);let n=pi.dot(this.direction),s=pi.dot(pi)-n*n,r=t.radius*t.radius;if(s>r)return null;let o=Math.sqrt(r-s),l=n-o,a=n+o;return a<0?null:l<0?this.at(a,e):this.at(l,e)}intersectsSphere(t){return t.radius<0?!1:this.distanceSqToPoint(t.center)<=t.radius*t.radius}distanceToPlane(t){let e=t.normal.dot(this.direction);if(e===0)return t.distanceToPoint(this.origin)===0?0:null;let n=-(this.origin.dot(t.normal)+t.constant)/e;return n>=0?n:null}intersectPlane(t,e){let n=this.distanceToPlane(t);return n===null?null:this.at(n,e)}intersectsPlane(t){let e=t.distanceToPoint(this.origin);return e===0||t.normal.dot(this.direction)*e<0}intersectBox(t,e){let n,s,r,o,l,a,c=1/this.direction.x,u=1/this.direction.y,h=1/this.direction.z,f=this.origin;return c>=0?(n=(t.min.x-f.x)*c,s=(t.max.x-f.x)*c):(n=(t.max.x-f.x)*c,s=(t.min.x-f.x)*c),u>=0?(r=(t.min.y-f.y)*u,o=(t.max.y-f.y)*u):(r=(t.max.y-f.y)*u,o=(t.min.y-f.y)*u),n>o||r>s||((r>n||isNaN(n))&&(n=r),(o<s||isNaN(s))&&(s=o),h>=0?(l=(t.min.z-f.z)*h,a=(t.max.z-f.z)*h):(l=(t.max.z-f.z)*h,a=(t.min.z-f.z)*h),n>a||l>s)||((l>n||n!==n)&&(n=l),(a<s||s!==s)&&(s=a),s<0)?null:this.at(n>=0?n:s,e)}intersectsBox(t){return this.intersectBox(t,pi)!==null}intersectTriangle(t,e,n,s,r){let o=this.origin,l=this.direction,a=l.x,c=l.y,u=l.z,h=t.x-o.x,f=t.y-o.y,d=t.z-o.z,g=e.x-o.x,y=e.y-o.y,p=e.z-o.z,m=n.x-o.x,x=n.y-o.y,M=n.z-o.z,v=Math.abs(a),S=Math.abs(c),A=Math.abs(u),_,b,L,E,C,I,U,P,B,H,G,et;if(v>=S&&v>=A?(L=a,I=h,B=g,et=m,a>=0?(_=c,b=u,E=f,C=d,U=y,P=p,H=x,G=M):(_=u,b=c,E=d,C=f,U=p,P=y,H=M,G=x)):S>=A?(L=c,I=f,B=y,et=x,c>=0?(_=u,b=a,E=d,C=h,U=p,P=g,H=M,G=m):(_=a,b=u,E=h,C=d,U=g,P=p,H=m,G=M)):(L=u,I=d,B=p,et=M,u>=0?(_=a,b=c,E=h,C=f,U=g,P=y,H=m,G=x):(_=c,b=a,E=f,C=h,U=y,P=g,H=x,G=m)),L===0)return null;let X=_/L,j=b/L,tt=1/L,yt=E-X*I,Nt=C-j*I,J=U-X*B,ut=P-j*B,_t=H-X*et,Tt=G-j*et,pt=_t*ut-Tt*J,Ut=yt*Tt-Nt*_t,Se=J*Nt-ut*yt;if(s){if(pt<0||Ut<0||Se<0)return null}else if((pt<0||Ut<0||Se<0)&&(pt>0||Ut>0||Se>0))return null;let Ct=pt+Ut+Se;if(Ct===0)return null;let Kt=tt*(pt*I+Ut*B+Se*et);return(Ct>0?Kt<0:Kt>0)?null:this.at(Kt/Ct,r)}applyMatrix4(t){return this.origin.applyMatrix4(t),this.direction.transformDirection(t),this}equals(t){return t.origin.equals(this.origin)&&t.direction.equals(this.direction)}clone(){return new this.constructor().copy(this)}},va=class extends Bi{constructor(t){super(),this.isMeshBasicMaterial=!0,this.type="MeshBasicMaterial",this.color=new Zt(16777215),this.map=null,this.lightMap=null,this.lightMapIntensity=1,this.aoMap=null,this.aoMapIntensity=1,this.specularMap=null,this.alphaMap=null,this.envMap=null,this.envMapRotation=new Fi,this.combine=Au,this.reflectivity=1,this.refractionRatio=.98,this.wireframe=!1,this.wireframeLinewidth=1,this.wireframeLinecap="round",this.wireframeLinejoin="round",this.fog=!0,this.setValues(t)}copy(t){return super.copy(t),this.color.copy(t.color),this.map=t.map,this.lightMap=t.lightMap,this.lightMapIntensity=t.lightMapIntensity,this.aoMap=t.aoMap,this.aoMapIntensity=t.aoMapIntensity,this.specularMap=t.specularMap,this.alphaMap=t.alphaMap,this.envMap=t.envMap,this.envMapRotation.copy(t.envMapRotation),this.combine=t.combine,this.reflectivity=t.reflectivity,this.refractionRatio=t.refractionRatio,this.wireframe=t.wireframe,this.wireframeLinewidth=t.wireframeLinewidth,this.wireframeLinecap=t.wireframeLinecap,this.wireframeLinejoin=t.wireframeLinejoin,this.fog=t.fog,this}},kf=new zt,as=new In,Xo=new cs,Vf=new N,qo=new N,Yo=new N,$o=new N,cu=new N,Zo=new N,Gf=new N,Jo=new N,de=class extends yn{constructor(t=new Xe,e=new va){super(),this.isMesh=!0,this.type="Mesh",this.geometry=t,this.material=e,this.morphTargetDictionary=void 0,this.morphTargetInfluences=void 0,this.count=1,this.updateMorphTargets()}copy(t,e){return super.copy(t,e),t.morphTargetInfluences!==void 0?this.morphTargetInfluences=t.morphTargetInfluences.slice():this.morphTargetInfluences=void 0,t.morphTargetDictionary!==void 0?this.morphTargetDictionary=Object.assign({},t.morphTargetDictionary):this.morphTargetDictionary=void 0,this.material=Array.isArray(t.material)?t.material.slice():t.material,this.geometry=t.geometry,this}updateMorphTargets(){let e=this.geometry.morphAttributes,n=Object.keys(e);if(n.length>0){let s=e[n[0]];if(s!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let r=0,o=s.length;r<o;r++){let l=s[r].name||String(r);this.morphTargetInfluences.push(0),this.morphTargetDictionary[l]=r}}}}getVertexPosition(t,e){let n=this.geometry,s=n.attributes.position,r=n.morphAttributes.position,o=n.morphTargetsRelative;e.fromBufferAttribute(s,t);let l=this.morphTargetInfluences;if(r&&l){Zo.set(0,0,0);for(let a=0,c=r.length;a<c;a++){let u=l[a],h=r[a];u!==0&&(cu.fromBufferAttribute(h,t),o?Zo.addScaledVector(cu,u):Zo.addScaledVector(cu.sub(e),u))}e.add(Zo)}return e}intersectsFrustum(t){return t.intersectsObject(this)}raycast(t,e){let n=this.geometry,s=this.material,r=this.matrixWorld;s!==void 0&&(n.boundingSphere===null&&n.computeBoundingSphere(),Xo.copy(n.boundingSphere),Xo.applyMatrix4(r),as.copy(t.ray).recast(t.near),!(Xo.containsPoint(as.origin)===!1&&(as.intersectSphere(Xo,Vf)===null||as.origin.distanceToSquared(Vf)>(t.far-t.near)**2))&&(kf.copy(r).invert(),as.copy(t.ray).applyMatrix4(kf),!(n.boundingBox!==null&&as.intersectsBox(n.boundingBox)===!1)&&this._computeIntersections(t,e,as)))}_computeIntersections(t,e,n){let s,r=this.geometry,o=this.material,l=r.index,a=r.attributes.position,c=r.attributes.uv,u=r.attributes.uv1,h=r.attributes.normal,f=r.groups,d=r.drawRange;if(l!==null)if(Array.isArray(o))for(let g=0,y=f.length;g<y;g++){let p=f[g],m=o[p.materialIndex],x=Math.max(p.start,d.start),M=Math.min(l.count,Math.min(p.start+p.count,d.start+d.count));for(let v=x,S=M;v<S;v+=3){let A=l.getX(v),_=l.getX(v+1),b=l.getX(v+2);s=Ko(this,m,t,n,c,u,h,A,_,b),s&&(s.faceIndex=Math.floor(v/3),s.face.materialIndex=p.materialIndex,e.push(s))}}else{let g=Math.max(0,d.start),y=Math.min(l.count,d.start+d.count);for(let p=g,m=y;p<m;p+=3){let x=l.getX(p),M=l.getX(p+1),v=l.getX(p+2);s=Ko(this,o,t,n,c,u,h,x,M,v),s&&(s.faceIndex=Math.floor(p/3),e.push(s))}}else if(a!==void 0)if(Array.isArray(o))for(let g=0,y=f.length;g<y;g++){let p=f[g],m=o[p.materialIndex],x=Math.max(p.start,d.start),M=Math.min(a.count,Math.min(p.start+p.count,d.start+d.count));for(let v=x,S=M;v<S;v+=3){let A=v,_=v+1,b=v+2;s=Ko(this,m,t,n,c,u,h,A,_,b),s&&(s.faceIndex=Math.floor(v/3),s.face.materialIndex=p.materialIndex,e.push(s))}}else{let g=Math.max(0,d.start),y=Math.min(a.count,d.start+d.count);for(let p=g,m=y;p<m;p+=3){let x=p,M=p+1,v=p+2;s=Ko(this,o,t,n,c,u,h,x,M,v),s&&(s.faceIndex=Math.floor(p/3),e.push(s))}}}};function Vg(i,t,e,n,s,r,o,l){let a;if(t.side===qe?a=n.intersectTriangle(o,r,s,!0,l):a=n.intersectTriangle(s,r,o,t.side===Vn,l),a===null)return null;Jo.copy(l),Jo.applyMatrix4(i.matrixWorld);let c=e.ray.origin.distanceTo(Jo);return c<e.near||c>e.far?null:{distance:c,point:Jo.clone(),object:i}}function Ko(i,t,e,n,s,r,o,l,a,c){i.getVertexPosition(l,qo),i.getVertexPosition(a,Yo),i.getVertexPosition(c,$o);let u=Vg(i,t,e,n,qo,Yo,$o,Gf);if(u){let h=new N;ke.getBarycoord(Gf,qo,Yo,$o,h),s&&(u.uv=ke.getInterpolatedAttribute(s,l,a,c,h,new Et)),r&&(u.uv1=ke.getInterpolatedAttribute(r,l,a,c,h,new Et)),o&&(u.normal=ke.getInterpolatedAttribute(o,l,a,c,h,new N),u.normal.dot(n.direction)>0&&u.normal.multiplyScalar(-1));let f={a:l,b:a,c,normal:new N,materialIndex:0};ke.getNormal(qo,Yo,$o,f.normal),u.face=f,u.barycoord=h}return u}var qs=class extends hn{constructor(t=null,e=1,n=1,s,r,o,l,a,c=Ce,u=Ce,h,f){super(null,o,l,a,c,u,s,r,h,f),this.isDataTexture=!0,this.image={data:t,width:e,height:n},this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1}};var ls=new cs,Gg=new Et(.5,.5),Qo=new N,us=class{constructor(t=new sn,e=new sn,n=new sn,s=new sn,r=new sn,o=new sn){this.planes=[t,e,n,s,r,o]}set(t,e,n,s,r,o){let l=this.planes;return l[0].copy(t),l[1].copy(e),l[2].copy(n),l[3].copy(s),l[4].copy(r),l[5].copy(o),this}copy(t){let e=this.planes;for(let n=0;n<6;n++)e[n].copy(t.planes[n]);return this}setFromProjectionMatrix(t,e=Pn,n=!1){let s=this.planes,r=t.elements,o=r[0],l=r[1],a=r[2],c=r[3],u=r[4],h=r[5],f=r[6],d=r[7],g=r[8],y=r[9],p=r[10],m=r[11],x=r[12],M=r[13],v=r[14],S=r[15];if(s[0].setComponents(c-o,d-u,m-g,S-x).normalize(),s[1].setComponents(c+o,d+u,m+g,S+x).normalize(),s[2].setComponents(c+l,d+h,m+y,S+M).normalize(),s[3].setComponents(c-l,d-h,m-y,S-M).normalize(),n)s[4].setComponents(a,f,p,v).normalize(),s[5].setComponents(c-a,d-f,m-p,S-v).normalize();else if(s[4].setComponents(c-a,d-f,m-p,S-v).normalize(),e===Pn)s[5].setComponents(c+a,d+f,m+p,S+v).normalize();else if(e===Dr)s[5].setComponents(a,f,p,v).normalize();else throw new Error("THREE.Frustum.setFromProjectionMatrix(): Invalid coordinate system: "+e);return this}intersectsObject(t){if(t.boundingSphere!==void 0)t.boundingSphere===null&&t.computeBoundingSphere(),ls.copy(t.boundingSphere).applyMatrix4(t.matrixWorld);else{let e=t.geometry;e.boundingSphere===null&&e.computeBoundingSphere(),ls.copy(e.boundingSphere).applyMatrix4(t.matrixWorld)}return this.intersectsSphere(ls)}intersectsSprite(t){ls.center.set(0,0,0);let e=Gg.distanceTo(t.center);return ls.radius=.7071067811865476+e,ls.applyMatrix4(t.matrixWorld),this.intersectsSphere(ls)}intersectsSphere(t){let e=this.planes,n=t.center,s=-t.radius;for(let r=0;r<6;r++)if(e[r].distanceToPoint(n)<s)return!1;return!0}intersectsBox(t){let e=this.planes;for(let n=0;n<6;n++){let s=e[n];if(Qo.x=s.normal.x>0?t.max.x:t.min.x,Qo.y=s.normal.y>0?t.max.y:t.min.y,Qo.z=s.normal.z>0?t.max.z:t.min.z,s.distanceToPoint(Qo)<0)return!1}return!0}containsPoint(t){let e=this.planes;for(let n=0;n<6;n++)if(e[n].distanceToPoint(t)<0)return!1;return!0}clone(){return new this.constructor().copy(this)}},Hf=new zt,Ma=class i{constructor(){this.coordinateSystem=Pn,this._frustums=[],this._count=0}setFromArrayCamera(t){let e=t.cameras,n=this._frustums;for(let s=0;s<e.length;s++){let r=e[s];Hf.multiplyMatrices(r.projectionMatrix,r.matrixWorldInverse),n[s]===void 0&&(n[s]=new us),n[s].setFromProjectionMatrix(Hf,r.coordinateSystem,r.reversedDepth)}return this._count=e.length,this}getFrustum(t){return this._frustums[t]}intersectsObject(t){let e=this._frustums;for(let n=0;n<this._count;n++)if(e[n].intersectsObject(t))return!0;return!1}intersectsSprite(t){let e=this._frustums;for(let n=0;n<this._count;n++)if(e[n].intersectsSprite(t))return!0;return!1}intersectsSphere(t){let e=this._frustums;for(let n=0;n<this._count;n++)if(e[n].intersectsSphere(t))return!0;return!1}intersectsBox(t){let e=this._frustums;for(let n=0;n<this._count;n++)if(e[n].intersectsBox(t))return!0;return!1}containsPoint(t){let e=this._frustums;for(let n=0;n<this._count;n++)if(e[n].containsPoint(t))return!0;return!1}copy(t){this.coordinateSystem=t.coordinateSystem;let e=this._frustums,n=t._frustums;for(let s=0;s<t._count;s++)e[s]===void 0&&(e[s]=new us),e[s].copy(n[s]);return this._count=t._count,this}clone(){return new i().copy(this)}};var Sa=class extends Bi{constructor(t){super(),this.isLineBasicMaterial=!0,this.type="LineBasicMaterial",this.color=new Zt(16777215),this.map=null,this.linewidth=1,this.linecap="round",this.linejoin="round",this.fog=!0,this.setValues(t)}copy(t){return super.copy(t),this.color.copy(t.color),this.map=t.map,this.linewidth=t.linewidth,this.linecap=t.linecap,this.linejoin=t.linejoin,this.fog=t.fog,this}},ba=new N,wa=new N,Wf=new zt,Cr=new In,jo=new cs,uu=new N,Xf=new N,Aa=class extends yn{constructor(t=new Xe,e=new Sa){super(),this.isLine=!0,this.type="Line",this.geometry=t,this.material=e,this.morphTargetDictionary=void 0,this.morphTargetInfluences=void 0,this.updateMorphTargets()}copy(t,e){return super.copy(t,e),t.morphTargetInfluences!==void 0?this.morphTargetInfluences=t.morphTargetInfluences.slice():this.morphTargetInfluences=void 0,t.morphTargetDictionary!==void 0?this.morphTargetDictionary=Object.assign({},t.morphTargetDictionary):this.morphTargetDictionary=void 0,this.material=Array.isArray(t.material)?t.material.slice():t.material,this.geometry=t.geometry,this}computeLineDistances(){let t=this.geometry;if(t.index===null){let e=t.attributes.position,n=[0];for(let s=1,r=e.count;s<r;s++)ba.fromBufferAttribute(e,s-1),wa.fromBufferAttribute(e,s),n[s]=n[s-1],n[s]+=ba.distanceTo(wa);t.setAttribute("lineDistance",new We(n,1))}else Rt("Line.computeLineDistances(): Computation only possible with non-indexed BufferGeometry.");return this}intersectsFrustum(t){return t.intersectsObject(this)}raycast(t,e){let n=this.geometry,s=this.matrixWorld,r=t.params.Line.threshold,o=n.drawRange;if(n.boundingSphere===null&&n.computeBoundingSphere(),jo.copy(n.boundingSphere),jo.applyMatrix4(s),jo.radius+=r,t.ray.intersectsSphere(jo)===!1)return;Wf.copy(s).invert(),Cr.copy(t.ray).applyMatrix4(Wf);let l=r/((this.scale.x+this.scale.y+this.scale.z)/3),a=l*l,c=this.isLineSegments?2:1,u=n.index,f=n.attributes.position;if(u!==null){let d=Math.max(0,o.start),g=Math.min(u.count,o.start+o.count);for(let y=d,p=g-1;y<p;y+=c){let m=u.getX(y),x=u.getX(y+1),M=ta(this,t,Cr,a,m,x,y);M&&e.push(M)}if(this.isLineLoop){let y=u.getX(g-1),p=u.getX(d),m=ta(this,t,Cr,a,y,p,g-1);m&&e.push(m)}}else{let d=Math.max(0,o.start),g=Math.min(f.count,o.start+o.count);for(let y=d,p=g-1;y<p;y+=c){let m=ta(this,t,Cr,a,y,y+1,y);m&&e.push(m)}if(this.isLineLoop){let y=ta(this,t,Cr,a,g-1,d,g-1);y&&e.push(y)}}}updateMorphTargets(){let e=this.geometry.morphAttributes,n=Object.keys(e);if(n.length>0){let s=e[n[0]];if(s!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let r=0,o=s.length;r<o;r++){let l=s[r].name||String(r);this.morphTargetInfluences.push(0),this.morphTargetDictionary[l]=r}}}}};function ta(i,t,e,n,s,r,o){let l=i.geometry.attributes.position;if(ba.fromBufferAttribute(l,s),wa.fromBufferAttribute(l,r),e.distanceSqToSegment(ba,wa,uu,Xf)>n)return;uu.applyMatrix4(i.matrixWorld);let c=t.ray.origin.distanceTo(uu);if(!(c<t.near||c>t.far))return{distance:c,point:Xf.clone().applyMatrix4(i.matrixWorld),index:o,face:null,faceIndex:null,barycoord:null,object:i}}var qf=new N,Yf=new N,kr=class extends Aa{constructor(t,e){super(t,e),this.isLineSegments=!0,this.type="LineSegments"}computeLineDistances(){let t=this.geometry;if(t.index===null){let e=t.attributes.position,n=[];for(let s=0,r=e.count;s<r;s+=2)qf.fromBufferAttribute(e,s),Yf.fromBufferAttribute(e,s+1),n[s]=s===0?0:n[s-1],n[s+1]=n[s]+qf.distanceTo(Yf);t.setAttribute("lineDistance",new We(n,1))}else Rt("LineSegments.computeLineDistances(): Computation only possible with non-indexed BufferGeometry.");return this}};var Vr=class extends hn{constructor(t=[],e=ds,n,s,r,o,l,a,c,u){super(t,e,n,s,r,o,l,a,c,u),this.isCubeTexture=!0,this.flipY=!1}get images(){return this.image}set images(t){this.image=t}};var _i=class extends hn{constructor(t,e,n=Gn,s,r,o,l=Ce,a=Ce,c,u=xi,h=1){if(u!==xi&&u!==Mi)throw new Error("THREE.DepthTexture: format must be either THREE.DepthFormat or THREE.DepthStencilFormat");let f={width:t,height:e,depth:h};super(f,s,r,o,l,a,u,n,c),this.isDepthTexture=!0,this.flipY=!1,this.generateMipmaps=!1,this.compareFunction=null}copy(t){return super.copy(t),this.source=new Hs(Object.assign({},t.image)),this.compareFunction=t.compareFunction,this}toJSON(t){let e=super.toJSON(t);return e.compareFunction=this.compareFunction,e}},Gr=class extends _i{constructor(t,e=Gn,n=ds,s,r,o=Ce,l=Ce,a,c=xi){let u={width:t,height:t,depth:1},h=[u,u,u,u,u,u];super(t,t,e,n,s,r,o,l,a,c),this.image=h,this.isCubeDepthTexture=!0,this.isCubeTexture=!0}get images(){return this.image}set images(t){this.image=t}},Hr=class extends hn{constructor(t=null){super(),this.sourceTexture=t,this.isExternalTexture=!0}copy(t){return super.copy(t),this.sourceTexture=t.sourceTexture,this}},Ys=class i extends Xe{constructor(t=1,e=1,n=1,s=1,r=1,o=1){super(),this.type="BoxGeometry",this.parameters={width:t,height:e,depth:n,widthSegments:s,heightSegments:r,depthSegments:o};let l=this;s=Math.floor(s),r=Math.floor(r),o=Math.floor(o);let a=[],c=[],u=[],h=[],f=0,d=0;g("z","y","x",-1,-1,n,e,t,o,r,0),g("z","y","x",1,-1,n,e,-t,o,r,1),g("x","z","y",1,1,t,n,e,s,o,2),g("x","z","y",1,-1,t,n,-e,s,o,3),g("x","y","z",1,-1,t,e,n,s,r,4),g("x","y","z",-1,-1,t,e,-n,s,r,5),this.setIndex(a),this.setAttribute("position",new We(c,3)),this.setAttribute("normal",new We(u,3)),this.setAttribute("uv",new We(h,2));function g(y,p,m,x,M,v,S,A,_,b,L){let E=v/_,C=S/b,I=v/2,U=S/2,P=A/2,B=_+1,H=b+1,G=0,et=0,X=new N;for(let j=0;j<H;j++){let tt=j*C-U;for(let yt=0;yt<B;yt++){let Nt=yt*E-I;X[y]=Nt*x,X[p]=tt*M,X[m]=P,c.push(X.x,X.y,X.z),X[y]=0,X[p]=0,X[m]=A>0?1:-1,u.push(X.x,X.y,X.z),h.push(yt/_),h.push(1-j/b),G+=1}}for(let j=0;j<b;j++)for(let tt=0;tt<_;tt++){let yt=f+tt+B*j,Nt=f+tt+B*(j+1),J=f+(tt+1)+B*(j+1),ut=f+(tt+1)+B*j;a.push(yt,Nt,ut),a.push(Nt,J,ut),et+=6}l.addGroup(d,et,L),d+=et,f+=G}}copy(t){return super.copy(t),this.parameters=Object.assign({},t.parameters),this}static fromJSON(t){return new i(t.width,t.height,t.depth,t.widthSegments,t.heightSegments,t.depthSegments)}};var Wr=class i extends Xe{constructor(t=[new Et(0,-.5),new Et(.5,0),new Et(0,.5)],e=12,n=0,s=Math.PI*2){super(),this.type="LatheGeometry",this.parameters={points:t,segments:e,phiStart:n,phiLength:s},e=Math.floor(e),s=Bt(s,0,Math.PI*2);let r=[],o=[],l=[],a=[],c=[],u=1/e,h=new N,f=new Et,d=new N,g=new N,y=new N,p=0,m=0;for(let x=0;x<=t.length-1;x++)switch(x){case 0:p=t[x+1].x-t[x].x,m=t[x+1].y-t[x].y,d.x=m*1,d.y=-p,d.z=m*0,y.copy(d),d.normalize(),a.push(d.x,d.y,d.z);break;case t.length-1:y.normalize(),a.push(y.x,y.y,y.z);break;default:p=t[x+1].x-t[x].x,m=t[x+1].y-t[x].y,d.x=m*1,d.y=-p,d.z=m*0,g.copy(d),d.x+=y.x,d.y+=y.y,d.z+=y.z,d.normalize(),a.push(d.x,d.y,d.z),y.copy(g)}for(let x=0;x<=e;x++){let M=n+x*u*s,v=Math.sin(M),S=Math.cos(M);for(let A=0;A<=t.length-1;A++){h.x=t[A].x*v,h.y=t[A].y,h.z=t[A].x*S,o.push(h.x,h.y,h.z),f.x=x/e,f.y=A/(t.length-1),l.push(f.x,f.y);let _=a[3*A+0]*v,b=a[3*A+1],L=a[3*A+0]*S;c.push(_,b,L)}}for(let x=0;x<e;x++)for(let M=0;M<t.length-1;M++){let v=M+x*t.length,S=v,A=v+t.length,_=v+t.length+1,b=v+1;r.push(S,A,b),r.push(_,b,A)}this.setIndex(r),this.setAttribute("position",new We(o,3)),this.setAttribute("uv",new We(l,2)),this.setAttribute("normal",new We(c,3))}copy(t){return super.copy(t),this.parameters=Object.assign({},t.parameters),this}static fromJSON(t){return new i(t.points,t.segments,t.phiStart,t.phiLength)}};var yi=class i extends Xe{constructor(t=1,e=1,n=1,s=1){super(),this.type="PlaneGeometry",this.parameters={width:t,height:e,widthSegments:n,heightSegments:s};let r=t/2,o=e/2,l=Math.floor(n),a=Math.floor(s),c=l+1,u=a+1,h=t/l,f=e/a,d=[],g=[],y=[],p=[];for(let m=0;m<u;m++){let x=m*f-o;for(let M=0;M<c;M++){let v=M*h-r;g.push(v,-x,0),y.push(0,0,1),p.push(M/l),p.push(1-m/a)}}for(let m=0;m<a;m++)for(let x=0;x<l;x++){let M=x+c*m,v=x+c*(m+1),S=x+1+c*(m+1),A=x+1+c*m;d.push(M,v,A),d.push(v,S,A)}this.setIndex(d),this.setAttribute("position",new We(g,3)),this.setAttribute("normal",new We(y,3)),this.setAttribute("uv",new We(p,2))}copy(t){return super.copy(t),this.parameters=Object.assign({},t.parameters),this}static fromJSON(t){return new i(t.width,t.height,t.widthSegments,t.heightSegments)}};function ms(i){let t={};for(let e in i){t[e]={};for(let n in i[e]){let s=i[e][n];if($f(s))s.isRenderTargetTexture?(Rt("UniformsUtils: Textures of render targets cannot be cloned via cloneUniforms() or mergeUniforms()."),t[e][n]=null):t[e][n]=s.clone();else if(Array.isArray(s))if($f(s[0])){let r=[];for(let o=0,l=s.length;o<l;o++)r[o]=s[o].clone();t[e][n]=r}else t[e][n]=s.slice();else t[e][n]=s}}return t}function tn(i){let t={};for(let e=0;e<i.length;e++){let n=ms(i[e]);for(let s in n)t[s]=n[s]}return t}function $f(i){return i&&(i.isColor||i.isMatrix3||i.isMatrix4||i.isVector2||i.isVector3||i.isVector4||i.isTexture||i.isQuaternion)}function Hg(i){let t=[];for(let e=0;e<i.length;e++)t.push(i[e].clone());return t}function Zu(i){let t=i.getRenderTarget();return t===null?i.outputColorSpace:t.isXRRenderTarget===!0?t.texture.colorSpace:Yt.workingColorSpace}var kd={clone:ms,merge:tn},Wg=`void main() {
	gl_Position = projectionMatrix * modelViewMatrix * vec4( position, 1.0 );
}`,Xg=`void main() {
	gl_FragColor = vec4( 1.0, 0.0, 0.0, 1.0 );
}`,je=class extends Bi{constructor(t){super(),this.isShaderMaterial=!0,this.type="ShaderMaterial",this.defines={},this.uniforms={},this.uniformsGroups=[],this.vertexShader=Wg,this.fragmentShader=Xg,this.linewidth=1,this.wireframe=!1,this.wireframeLinewidth=1,this.fog=!1,this.lights=!1,this.clipping=!1,this.forceSinglePass=!0,this.extensions={clipCullDistance:!1,multiDraw:!1},this.defaultAttributeValues={color:[1,1,1],uv:[0,0],uv1:[0,0]},this.index0AttributeName=void 0,this.uniformsNeedUpdate=!1,this.glslVersion=null,t!==void 0&&this.setValues(t)}copy(t){return super.copy(t),this.fragmentShader=t.fragmentShader,this.vertexShader=t.vertexShader,this.uniforms=ms(t.uniforms),this.uniformsGroups=Hg(t.uniformsGroups),this.defines=Object.assign({},t.defines),this.wireframe=t.wireframe,this.wireframeLinewidth=t.wireframeLinewidth,this.fog=t.fog,this.lights=t.lights,this.clipping=t.clipping,this.extensions=Object.assign({},t.extensions),this.glslVersion=t.glslVersion,this.defaultAttributeValues=Object.assign({},t.defaultAttributeValues),this.index0AttributeName=t.index0AttributeName,this.uniformsNeedUpdate=t.uniformsNeedUpdate,this}toJSON(t){let e=super.toJSON(t);e.glslVersion=this.glslVersion,e.uniforms={};for(let s in this.uniforms){let o=this.uniforms[s].value;o&&o.isTexture?e.uniforms[s]={type:"t",value:o.toJSON(t).uuid}:o&&o.isColor?e.uniforms[s]={type:"c",value:o.getHex()}:o&&o.isVector2?e.uniforms[s]={type:"v2",value:o.toArray()}:o&&o.isVector3?e.uniforms[s]={type:"v3",value:o.toArray()}:o&&o.isVector4?e.uniforms[s]={type:"v4",value:o.toArray()}:o&&o.isMatrix3?e.uniforms[s]={type:"m3",value:o.toArray()}:o&&o.isMatrix4?e.uniforms[s]={type:"m4",value:o.toArray()}:e.uniforms[s]={value:o}}Object.keys(this.defines).length>0&&(e.defines=this.defines),e.vertexShader=this.vertexShader,e.fragmentShader=this.fragmentShader,e.lights=this.lights,e.clipping=this.clipping;let n={};for(let s in this.extensions)this.extensions[s]===!0&&(n[s]=!0);return Object.keys(n).length>0&&(e.extensions=n),e}fromJSON(t,e){if(super.fromJSON(t,e),t.uniforms!==void 0)for(let n in t.uniforms){let s=t.uniforms[n];switch(this.uniforms[n]={},s.type){case"t":this.uniforms[n].value=e[s.value]||null;break;case"c":this.uniforms[n].value=new Zt().setHex(s.value);break;case"v2":this.uniforms[n].value=new Et().fromArray(s.value);break;case"v3":this.uniforms[n].value=new N().fromArray(s.value);break;case"v4":this.uniforms[n].value=new me().fromArray(s.value);break;case"m3":this.uniforms[n].value=new Dt().fromArray(s.value);break;case"m4":this.uniforms[n].value=new zt().fromArray(s.value);break;default:this.uniforms[n].value=s.value}}if(t.defines!==void 0&&(this.defines=t.defines),t.vertexShader!==void 0&&(this.vertexShader=t.vertexShader),t.fragmentShader!==void 0&&(this.fragmentShader=t.fragmentShader),t.glslVersion!==void 0&&(this.glslVersion=t.glslVersion),t.extensions!==void 0)for(let n in t.extensions)this.extensions[n]=t.extensions[n];return t.lights!==void 0&&(this.lights=t.lights),t.clipping!==void 0&&(this.clipping=t.clipping),this}},Ta=class extends je{constructor(t){super(t),this.isRawShaderMaterial=!0,this.type="RawShaderMaterial"}};var Ea=class extends Bi{constructor(t){super(),this.isMeshDepthMaterial=!0,this.type="MeshDepthMaterial",this.depthPacking=Td,this.map=null,this.alphaMap=null,this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.wireframe=!1,this.wireframeLinewidth=1,this.setValues(t)}copy(t){return super.copy(t),this.depthPacking=t.depthPacking,this.map=t.map,this.alphaMap=t.alphaMap,this.displacementMap=t.displacementMap,this.displacementScale=t.displacementScale,this.displacementBias=t.displacementBias,this.wireframe=t.wireframe,this.wireframeLinewidth=t.wireframeLinewidth,this}},Ra=class extends Bi{constructor(t){super(),this.isMeshDistanceMaterial=!0,this.type="MeshDistanceMaterial",this.map=null,this.alphaMap=null,this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.setValues(t)}copy(t){return super.copy(t),this.map=t.map,this.alphaMap=t.alphaMap,this.displacementMap=t.displacementMap,this.displacementScale=t.displacementScale,this.displacementBias=t.displacementBias,this}};function Ds(i,t){return!i||i.constructor===t?i:typeof t.BYTES_PER_ELEMENT=="number"?new t(i):Array.prototype.slice.call(i)}function ea(i){return i!==void 0&&i.inTangents!==void 0&&i.outTangents!==void 0}var zi=class{constructor(t,e,n,s){this.parameterPositions=t,this._cachedIndex=0,this.resultBuffer=s!==void 0?s:new e.constructor(n),this.sampleValues=e,this.valueSize=n,this.settings=null,this.DefaultSettings_={}}evaluate(t){let e=this.parameterPositions,n=this._cachedIndex,s=e[n],r=e[n-1];n:{t:{let o;e:{i:if(!(t<s)){for(let l=n+2;;){if(s===void 0){if(t<r)break i;return n=e.length,this._cachedIndex=n,this.copySampleValue_(n-1)}if(n===l)break;if(r=s,s=e[++n],t<s)break t}o=e.length;break e}if(!(t>=r)){let l=e[1];t<l&&(n=2,r=l);for(let a=n-2;;){if(r===void 0)return this._cachedIndex=0,this.copySampleValue_(0);if(n===a)break;if(s=r,r=e[--n-1],t>=r)break t}o=n,n=0;break e}break n}for(;n<o;){let l=n+o>>>1;t<e[l]?o=l:n=l+1}if(s=e[n],r=e[n-1],r===void 0)return this._cachedIndex=0,this.copySampleValue_(0);if(s===void 0)return n=e.length,this._cachedIndex=n,this.copySampleValue_(n-1)}this._cachedIndex=n,this.intervalChanged_(n,r,s)}return this.interpolate_(n,r,t,s)}getSettings_(){return this.settings||this.DefaultSettings_}copySampleValue_(t){let e=this.resultBuffer,n=this.sampleValues,s=this.valueSize,r=t*s;for(let o=0;o!==s;++o)e[o]=n[r+o];return e}interpolate_(){throw new Error("THREE.Interpolant: Call to abstract method.")}intervalChanged_(){}},Ca=class extends zi{constructor(t,e,n,s){super(t,e,n,s),this._weightPrev=-0,this._offsetPrev=-0,this._weightNext=-0,this._offsetNext=-0,this.DefaultSettings_={endingStart:du,endingEnd:du}}intervalChanged_(t,e,n){let s=this.parameterPositions,r=t-2,o=t+1,l=s[r],a=s[o];if(l===void 0)switch(this.getSettings_().endingStart){case pu:r=t,l=2*e-n;break;case mu:r=s.length-2,l=e+s[r]-s[r+1];break;default:r=t,l=n}if(a===void 0)switch(this.getSettings_().endingEnd){case pu:o=t,a=2*n-e;break;case mu:o=1,a=n+s[1]-s[0];break;default:o=t-1,a=e}let c=(n-e)*.5,u=this.valueSize;this._weightPrev=c/(e-l),this._weightNext=c/(a-n),this._offsetPrev=r*u,this._offsetNext=o*u}interpolate_(t,e,n,s){let r=this.resultBuffer,o=this.sampleValues,l=this.valueSize,a=t*l,c=a-l,u=this._offsetPrev,h=this._offsetNext,f=this._weightPrev,d=this._weightNext,g=(n-e)/(s-e),y=g*g,p=y*g,m=-f*p+2*f*y-f*g,x=(1+f)*p+(-1.5-2*f)*y+(-.5+f)*g+1,M=(-1-d)*p+(1.5+d)*y+.5*g,v=d*p-d*y;for(let S=0;S!==l;++S)r[S]=m*o[u+S]+x*o[c+S]+M*o[a+S]+v*o[h+S];return r}},Pa=class extends zi{constructor(t,e,n,s){super(t,e,n,s)}interpolate_(t,e,n,s){let r=this.resultBuffer,o=this.sampleValues,l=this.valueSize,a=t*l,c=a-l,u=(n-e)/(s-e),h=1-u;for(let f=0;f!==l;++f)r[f]=o[c+f]*h+o[a+f]*u;return r}},Ia=class extends zi{constructor(t,e,n,s){super(t,e,n,s)}interpolate_(t){return this.copySampleValue_(t-1)}},La=class extends zi{interpolate_(t,e,n,s){let r=this.resultBuffer,o=this.sampleValues,l=this.valueSize,a=t*l,c=a-l,u=this.inTangents,h=this.outTangents;if(!u||!h){let g=(n-e)/(s-e),y=1-g;for(let p=0;p!==l;++p)r[p]=o[c+p]*y+o[a+p]*g;return r}let f=l*2,d=t-1;for(let g=0;g!==l;++g){let y=o[c+g],p=o[a+g],m=d*f+g*2,x=h[m],M=h[m+1],v=t*f+g*2,S=u[v],A=u[v+1],_=Yg(n,e,x,S,s);r[g]=Vd(_,y,M,A,p)}return r}};function Vd(i,t,e,n,s){let r=1-i;return r*r*r*t+3*r*r*i*e+3*r*i*i*n+i*i*i*s}function qg(i,t,e,n,s){let r=1-i;return 3*r*r*(e-t)+6*r*i*(n-e)+3*i*i*(s-n)}function Yg(i,t,e,n,s){let r=(i-t)/(s-t);for(let o=0;o<8;o++){let l=Vd(r,t,e,n,s)-i;if(Math.abs(l)<1e-10)break;let a=qg(r,t,e,n,s);if(Math.abs(a)<1e-10)break;r=Math.max(0,Math.min(1,r-l/a))}return r}var vn=class{constructor(t,e,n,s){if(t===void 0)throw new Error("THREE.KeyframeTrack: track name is undefined");if(e===void 0||e.length===0)throw new Error("THREE.KeyframeTrack: no keyframes in track named "+t);this.name=t,this.times=Ds(e,this.TimeBufferType),this.values=Ds(n,this.ValueBufferType),this.setInterpolation(s||this.DefaultInterpolation)}static toJSON(t){let e=t.constructor,n;if(e.toJSON!==this.toJSON)n=e.toJSON(t);else{n={name:t.name,times:Ds(t.times,Array),values:Ds(t.values,Array)};let s=t.getInterpolation();s!==t.DefaultInterpolation&&(n.interpolation=s),ea(t.settings)&&(n.settings={inTangents:Ds(t.settings.inTangents,Array),outTangents:Ds(t.settings.outTangents,Array)})}return n.type=t.ValueTypeName,n}InterpolantFactoryMethodDiscrete(t){return new Ia(this.times,this.values,this.getValueSize(),t)}InterpolantFactoryMethodLinear(t){return new Pa(this.times,this.values,this.getValueSize(),t)}InterpolantFactoryMethodSmooth(t){return new Ca(this.times,this.values,this.getValueSize(),t)}InterpolantFactoryMethodBezier(t){let e=new La(this.times,this.values,this.getValueSize(),t);return this.settings&&(e.inTangents=this.settings.inTangents,e.outTangents=this.settings.outTangents),e}setInterpolation(t){let e;switch(t){case Ir:e=this.InterpolantFactoryMethodDiscrete;break;case ma:e=this.InterpolantFactoryMethodLinear;break;case ra:e=this.InterpolantFactoryMethodSmooth;break;case fu:e=this.InterpolantFactoryMethodBezier;break}if(e===void 0){let n="unsupported interpolation for "+this.ValueTypeName+" keyframe track named "+this.name;if(this.createInterpolant===void 0)if(t!==this.DefaultInterpolation)this.setInterpolation(this.DefaultInterpolation);else throw new Error(n);return Rt("KeyframeTrack:",n),this}return this.createInterpolant=e,this}getInterpolation(){switch(this.createInterpolant){case this.InterpolantFactoryMethodDiscrete:return Ir;case this.InterpolantFactoryMethodLinear:return ma;case this.InterpolantFactoryMethodSmooth:return ra;case this.InterpolantFactoryMethodBezier:return fu}}getValueSize(){return this.values.length/this.times.length}shift(t){if(t!==0){let e=this.times;for(let n=0,s=e.length;n!==s;++n)e[n]+=t;ea(this.settings)&&(Zf(this.settings.inTangents,t),Zf(this.settings.outTangents,t))}return this}scale(t){if(t!==1){let e=this.times;for(let n=0,s=e.length;n!==s;++n)e[n]*=t;ea(this.settings)&&(Jf(this.settings.inTangents,t),Jf(this.settings.outTangents,t))}return this}trim(t,e){let n=this.times,s=n.length,r=0,o=s-1;for(;r!==s&&n[r]<t;)++r;for(;o!==-1&&n[o]>e;)--o;if(++o,r!==0||o!==s){r>=o&&(o=Math.max(o,1),r=o-1);let l=this.getValueSize();this.times=n.slice(r,o),this.values=this.values.slice(r*l,o*l)}return this}validate(){let t=!0,e=this.getValueSize();e-Math.floor(e)!==0&&(Lt("KeyframeTrack: Invalid value size in track.",this),t=!1);let n=this.times,s=this.values,r=n.length;r===0&&(Lt("KeyframeTrack: Track is empty.",this),t=!1);let o=null;for(let l=0;l!==r;l++){let a=n[l];if(typeof a=="number"&&isNaN(a)){Lt("KeyframeTrack: Time is not a valid number.",this,l,a),t=!1;break}if(o!==null&&o>a){Lt("KeyframeTrack: Out of order keys.",this,l,a,o),t=!1;break}o=a}if(s!==void 0&&_g(s))for(let l=0,a=s.length;l!==a;++l){let c=s[l];if(isNaN(c)){Lt("KeyframeTrack: Value is not a valid number.",this,l,c),t=!1;break}}return t}optimize(){let t=this.times.slice(),e=this.values.slice(),n=this.getValueSize(),s=this.getInterpolation()===ra,r=t.length-1,o=1;for(let l=1;l<r;++l){let a=!1,c=t[l],u=t[l+1];if(c!==u&&(l!==1||c!==t[0]))if(s)a=!0;else{let h=l*n,f=h-n,d=h+n;for(let g=0;g!==n;++g){let y=e[h+g];if(y!==e[f+g]||y!==e[d+g]){a=!0;break}}}if(a){if(l!==o){t[o]=t[l];let h=l*n,f=o*n;for(let d=0;d!==n;++d)e[f+d]=e[h+d]}++o}}if(r>0){t[o]=t[r];for(let l=r*n,a=o*n,c=0;c!==n;++c)e[a+c]=e[l+c];++o}return o!==t.length?(this.times=t.slice(0,o),this.values=e.slice(0,o*n)):(this.times=t,this.values=e),this}clone(){let t=this.times.slice(),e=this.values.slice(),n=this.constructor,s=new n(this.name,t,e);return s.createInterpolant=this.createInterpolant,ea(this.settings)&&(s.settings={inTangents:this.settings.inTangents.slice(),outTangents:this.settings.outTangents.slice()}),s}};function Zf(i,t){for(let e=0,n=i.length;e!==n;e+=2)i[e]+=t}function Jf(i,t){for(let e=0,n=i.length;e!==n;e+=2)i[e]*=t}vn.prototype.ValueTypeName="";vn.prototype.TimeBufferType=Float32Array;vn.prototype.ValueBufferType=Float32Array;vn.prototype.DefaultInterpolation=ma;var ki=class extends vn{constructor(t,e,n){super(t,e,n)}};ki.prototype.ValueTypeName="bool";ki.prototype.ValueBufferType=Array;ki.prototype.DefaultInterpolation=Ir;ki.prototype.InterpolantFactoryMethodLinear=void 0;ki.prototype.InterpolantFactoryMethodSmooth=void 0;var Na=class extends vn{constructor(t,e,n,s){super(t,e,n,s)}};Na.prototype.ValueTypeName="color";var Da=class extends vn{constructor(t,e,n,s){super(t,e,n,s)}};Da.prototype.ValueTypeName="number";var Ua=class extends zi{constructor(t,e,n,s){super(t,e,n,s)}interpolate_(t,e,n,s){let r=this.resultBuffer,o=this.sampleValues,l=this.valueSize,a=(n-e)/(s-e),c=t*l;for(let u=c+l;c!==u;c+=4)Kn.slerpFlat(r,0,o,c-l,o,c,a);return r}},Xr=class extends vn{constructor(t,e,n,s){super(t,e,n,s)}InterpolantFactoryMethodLinear(t){return new Ua(this.times,this.values,this.getValueSize(),t)}};Xr.prototype.ValueTypeName="quaternion";Xr.prototype.InterpolantFactoryMethodSmooth=void 0;var Vi=class extends vn{constructor(t,e,n){super(t,e,n)}};Vi.prototype.ValueTypeName="string";Vi.prototype.ValueBufferType=Array;Vi.prototype.DefaultInterpolation=Ir;Vi.prototype.InterpolantFactoryMethodLinear=void 0;Vi.prototype.InterpolantFactoryMethodSmooth=void 0;var Fa=class extends vn{constructor(t,e,n,s){super(t,e,n,s)}};Fa.prototype.ValueTypeName="vector";var Oa=class{constructor(t,e,n){let s=this,r=!1,o=0,l=0,a,c=[];this.onStart=void 0,this.onLoad=t,this.onProgress=e,this.onError=n,this._abortController=null,this.itemStart=function(u){l++,r===!1&&s.onStart!==void 0&&s.onStart(u,o,l),r=!0},this.itemEnd=function(u){o++,s.onProgress!==void 0&&s.onProgress(u,o,l),o===l&&(r=!1,s.onLoad!==void 0&&s.onLoad())},this.itemError=function(u){s.onError!==void 0&&s.onError(u)},this.resolveURL=function(u){return u=u.normalize("NFC"),a?a(u):u},this.setURLModifier=function(u){return a=u,this},this.addHandler=function(u,h){return c.push(u,h),this},this.removeHandler=function(u){let h=c.indexOf(u);return h!==-1&&c.splice(h,2),this},this.getHandler=function(u){for(let h=0,f=c.length;h<f;h+=2){let d=c[h],g=c[h+1];if(d.global&&(d.lastIndex=0),d.test(u))return g}return null},this.abort=function(){return this.abortController.abort(),this._abortController=null,this}}get abortController(){return this._abortController||(this._abortController=new AbortController),this._abortController}},Gd=new Oa,Ba=class{constructor(t){this.manager=t!==void 0?t:Gd,this.crossOrigin="anonymous",this.withCredentials=!1,this.path="",this.resourcePath="",this.requestHeader={},this.priority="auto",this.cache="default",typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("observe",{detail:this}))}load(){}loadAsync(t,e){let n=this;return new Promise(function(s,r){n.load(t,s,e,r)})}parse(){}setCrossOrigin(t){return this.crossOrigin=t,this}setWithCredentials(t){return this.withCredentials=t,this}setPath(t){return this.path=t,this}setResourcePath(t){return this.resourcePath=t,this}setRequestHeader(t){return this.requestHeader=t,this}setPriority(t){return this.priority=t,this}setCache(t){return this.cache=t,this}abort(){return this}};Ba.DEFAULT_MATERIAL_NAME="__DEFAULT";var na=new N,ia=new Kn,$n=new N,qr=class extends yn{constructor(){super(),this.isCamera=!0,this.type="Camera",this.matrixWorldInverse=new zt,this.projectionMatrix=new zt,this.projectionMatrixInverse=new zt,this.coordinateSystem=Pn,this._reversedDepth=!1}get reversedDepth(){return this._reversedDepth}copy(t,e){return super.copy(t,e),this.matrixWorldInverse.copy(t.matrixWorldInverse),this.projectionMatrix.copy(t.projectionMatrix),this.projectionMatrixInverse.copy(t.projectionMatrixInverse),this.coordinateSystem=t.coordinateSystem,this}getWorldDirection(t){return super.getWorldDirection(t).negate()}updateMatrixWorld(t){super.updateMatrixWorld(t),this.matrixWorld.decompose(na,ia,$n),$n.x===1&&$n.y===1&&$n.z===1?this.matrixWorldInverse.copy(this.matrixWorld).invert():this.matrixWorldInverse.compose(na,ia,$n.set(1,1,1)).invert()}updateWorldMatrix(t,e,n=!1){super.updateWorldMatrix(t,e,n),this.matrixWorld.decompose(na,ia,$n),$n.x===1&&$n.y===1&&$n.z===1?this.matrixWorldInverse.copy(this.matrixWorld).invert():this.matrixWorldInverse.compose(na,ia,$n.set(1,1,1)).invert()}clone(){return new this.constructor().copy(this)}},Ui=new N,Kf=new Et,Qf=new Et,xn=class extends qr{constructor(t=50,e=1,n=.1,s=2e3){super(),this.isPerspectiveCamera=!0,this.type="PerspectiveCamera",this.fov=t,this.zoom=1,this.near=n,this.far=s,this.focus=10,this.aspect=e,this.view=null,this.filmGauge=35,this.filmOffset=0,this.updateProjectionMatrix()}copy(t,e){return super.copy(t,e),this.fov=t.fov,this.zoom=t.zoom,this.near=t.near,this.far=t.far,this.focus=t.focus,this.aspect=t.aspect,this.view=t.view===null?null:Object.assign({},t.view),this.filmGauge=t.filmGauge,this.filmOffset=t.filmOffset,this}setFocalLength(t){let e=.5*this.getFilmHeight()/t;this.fov=ga*2*Math.atan(e),this.updateProjectionMatrix()}getFocalLength(){let t=Math.tan(Hc*.5*this.fov);return .5*this.getFilmHeight()/t}getEffectiveFOV(){return ga*2*Math.atan(Math.tan(Hc*.5*this.fov)/this.zoom)}getFilmWidth(){return this.filmGauge*Math.min(this.aspect,1)}getFilmHeight(){return this.filmGauge/Math.max(this.aspect,1)}getViewBounds(t,e,n){Ui.set(-1,-1,.5).applyMatrix4(this.projectionMatrixInverse),e.set(Ui.x,Ui.y).multiplyScalar(-t/Ui.z),Ui.set(1,1,.5).applyMatrix4(this.projectionMatrixInverse),n.set(Ui.x,Ui.y).multiplyScalar(-t/Ui.z)}getViewSize(t,e){return this.getViewBounds(t,Kf,Qf),e.subVectors(Qf,Kf)}setViewOffset(t,e,n,s,r,o){this.aspect=t/e,this.view===null&&(this.view={enabled:!0,fullWidth:1,fullHeight:1,offsetX:0,offsetY:0,width:1,height:1}),this.view.enabled=!0,this.view.fullWidth=t,this.view.fullHeight=e,this.view.offsetX=n,this.view.offsetY=s,this.view.width=r,this.view.height=o,this.updateProjectionMatrix()}clearViewOffset(){this.view!==null&&(this.view.enabled=!1),this.updateProjectionMatrix()}updateProjectionMatrix(){let t=this.near,e=t*Math.tan(Hc*.5*this.fov)/this.zoom,n=2*e,s=this.aspect*n,r=-.5*s,o=this.view;if(this.view!==null&&this.view.enabled){let a=o.fullWidth,c=o.fullHeight;r+=o.offsetX*s/a,e-=o.offsetY*n/c,s*=o.width/a,n*=o.height/c}let l=this.filmOffset;l!==0&&(r+=t*l/this.getFilmWidth()),this.projectionMatrix.makePerspective(r,r+s,e,e-n,t,this.far,this.coordinateSystem,this.reversedDepth),this.projectionMatrixInverse.copy(this.projectionMatrix).invert()}toJSON(t){let e=super.toJSON(t);return e.object.fov=this.fov,e.object.zoom=this.zoom,e.object.near=this.near,e.object.far=this.far,e.object.focus=this.focus,e.object.aspect=this.aspect,this.view!==null&&(e.object.view=Object.assign({},this.view)),e.object.filmGauge=this.filmGauge,e.object.filmOffset=this.filmOffset,e}};var Gi=class extends qr{constructor(t=-1,e=1,n=1,s=-1,r=.1,o=2e3){super(),this.isOrthographicCamera=!0,this.type="OrthographicCamera",this.zoom=1,this.view=null,this.left=t,this.right=e,this.top=n,this.bottom=s,this.near=r,this.far=o,this.updateProjectionMatrix()}copy(t,e){return super.copy(t,e),this.left=t.left,this.right=t.right,this.top=t.top,this.bottom=t.bottom,this.near=t.near,this.far=t.far,this.zoom=t.zoom,this.view=t.view===null?null:Object.assign({},t.view),this}setViewOffset(t,e,n,s,r,o){this.view===null&&(this.view={enabled:!0,fullWidth:1,fullHeight:1,offsetX:0,offsetY:0,width:1,height:1}),this.view.enabled=!0,this.view.fullWidth=t,this.view.fullHeight=e,this.view.offsetX=n,this.view.offsetY=s,this.view.width=r,this.view.height=o,this.updateProjectionMatrix()}clearViewOffset(){this.view!==null&&(this.view.enabled=!1),this.updateProjectionMatrix()}updateProjectionMatrix(){let t=(this.right-this.left)/(2*this.zoom),e=(this.top-this.bottom)/(2*this.zoom),n=(this.right+this.left)/2,s=(this.top+this.bottom)/2,r=n-t,o=n+t,l=s+e,a=s-e;if(this.view!==null&&this.view.enabled){let c=(this.right-this.left)/this.view.fullWidth/this.zoom,u=(this.top-this.bottom)/this.view.fullHeight/this.zoom;r+=c*this.view.offsetX,o=r+c*this.view.width,l-=u*this.view.offsetY,a=l-u*this.view.height}this.projectionMatrix.makeOrthographic(r,o,l,a,this.near,this.far,this.coordinateSystem,this.reversedDepth),this.projectionMatrixInverse.copy(this.projectionMatrix).invert()}toJSON(t){let e=super.toJSON(t);return e.object.zoom=this.zoom,e.object.left=this.left,e.object.right=this.right,e.object.top=this.top,e.object.bottom=this.bottom,e.object.near=this.near,e.object.far=this.far,this.view!==null&&(e.object.view=Object.assign({},this.view)),e}};var Us=-90,Fs=1,$s=class extends yn{constructor(t,e,n){super(),this.type="CubeCamera",this.renderTarget=n,this.coordinateSystem=null,this.activeMipmapLevel=0;let s=new xn(Us,Fs,t,e);s.layers=this.layers,this.add(s);let r=new xn(Us,Fs,t,e);r.layers=this.layers,this.add(r);let o=new xn(Us,Fs,t,e);o.layers=this.layers,this.add(o);let l=new xn(Us,Fs,t,e);l.layers=this.layers,this.add(l);let a=new xn(Us,Fs,t,e);a.layers=this.layers,this.add(a);let c=new xn(Us,Fs,t,e);c.layers=this.layers,this.add(c)}updateCoordinateSystem(){let t=this.coordinateSystem,e=this.children.concat(),[n,s,r,o,l,a]=e;for(let c of e)this.remove(c);if(t===Pn)n.up.set(0,1,0),n.lookAt(1,0,0),s.up.set(0,1,0),s.lookAt(-1,0,0),r.up.set(0,0,-1),r.lookAt(0,1,0),o.up.set(0,0,1),o.lookAt(0,-1,0),l.up.set(0,1,0),l.lookAt(0,0,1),a.up.set(0,1,0),a.lookAt(0,0,-1);else if(t===Dr)n.up.set(0,-1,0),n.lookAt(-1,0,0),s.up.set(0,-1,0),s.lookAt(1,0,0),r.up.set(0,0,1),r.lookAt(0,1,0),o.up.set(0,0,-1),o.lookAt(0,-1,0),l.up.set(0,-1,0),l.lookAt(0,0,1),a.up.set(0,-1,0),a.lookAt(0,0,-1);else throw new Error("THREE.CubeCamera.updateCoordinateSystem(): Invalid coordinate system: "+t);for(let c of e)this.add(c),c.updateMatrixWorld()}update(t,e){this.parent===null&&this.updateMatrixWorld();let{renderTarget:n,activeMipmapLevel:s}=this;this.coordinateSystem!==t.coordinateSystem&&(this.coordinateSystem=t.coordinateSystem,this.updateCoordinateSystem());let[r,o,l,a,c,u]=this.children,h=t.getRenderTarget(),f=t.getActiveCubeFace(),d=t.getActiveMipmapLevel(),g=t.xr.enabled;t.xr.enabled=!1;let y=n.texture.mipmapsAutoUpdate;n.texture.mipmapsAutoUpdate=!1;let p=!1;t.isWebGLRenderer===!0?p=t.state.buffers.depth.getReversed():p=t.reversedDepthBuffer,t.setRenderTarget(n,0,s),p&&t.autoClear===!1&&t.clearDepth(),t.render(e,r),t.setRenderTarget(n,1,s),p&&t.autoClear===!1&&t.clearDepth(),t.render(e,o),t.setRenderTarget(n,2,s),p&&t.autoClear===!1&&t.clearDepth(),t.render(e,l),t.setRenderTarget(n,3,s),p&&t.autoClear===!1&&t.clearDepth(),t.render(e,a),t.setRenderTarget(n,4,s),p&&t.autoClear===!1&&t.clearDepth(),t.render(e,c),n.texture.mipmapsAutoUpdate=y,t.setRenderTarget(n,5,s),p&&t.autoClear===!1&&t.clearDepth(),t.render(e,u),t.setRenderTarget(h,f,d),t.xr.enabled=g,n.texture.needsPMREMUpdate=!0}},za=class extends xn{constructor(t=[]){super(),this.isArrayCamera=!0,this.isMultiViewCamera=!1,this.cameras=t,this.perCameraFrustumCulled=!1}};var Ju="\\[\\]\\.:\\/",$g=new RegExp("["+Ju+"]","g"),Ku="[^"+Ju+"]",Zg="[^"+Ju.replace("\\.","")+"]",Jg=/((?:WC+[\/:])*)/.source.replace("WC",Ku),Kg=/(WCOD+)?/.source.replace("WCOD",Zg),Qg=/(?:\.(WC+)(?:\[(.+)\])?)?/.source.replace("WC",Ku),jg=/\.(WC+)(?:\[(.+)\])?/.source.replace("WC",Ku),t0=new RegExp("^"+Jg+Kg+Qg+jg+"$"),e0=["material","materials","bones","map"],gu=class{constructor(t,e,n){let s=n||pe.parseTrackName(e);this._targetGroup=t,this._bindings=t.subscribe_(e,s)}getValue(t,e){this.bind();let n=this._targetGroup.nCachedObjects_,s=this._bindings[n];s!==void 0&&s.getValue(t,e)}setValue(t,e){let n=this._bindings;for(let s=this._targetGroup.nCachedObjects_,r=n.length;s!==r;++s)n[s].setValue(t,e)}bind(){let t=this._bindings;for(let e=this._targetGroup.nCachedObjects_,n=t.length;e!==n;++e)t[e].bind()}unbind(){let t=this._bindings;for(let e=this._targetGroup.nCachedObjects_,n=t.length;e!==n;++e)t[e].unbind()}},pe=class i{constructor(t,e,n){this.path=e,this.parsedPath=n||i.parseTrackName(e),this.node=i.findNode(t,this.parsedPath.nodeName),this.rootNode=t,this.getValue=this._getValue_unbound,this.setValue=this._setValue_unbound}static create(t,e,n){return t&&t.isAnimationObjectGroup?new i.Composite(t,e,n):new i(t,e,n)}static sanitizeNodeName(t){return t.replace(/\s/g,"_").replace($g,"")}static parseTrackName(t){let e=t0.exec(t);if(e===null)throw new Error("THREE.PropertyBinding: Cannot parse trackName: "+t);let n={nodeName:e[2],objectName:e[3],objectIndex:e[4],propertyName:e[5],propertyIndex:e[6]},s=n.nodeName&&n.nodeName.lastIndexOf(".");if(s!==void 0&&s!==-1){let r=n.nodeName.substring(s+1);e0.indexOf(r)!==-1&&(n.nodeName=n.nodeName.substring(0,s),n.objectName=r)}if(n.propertyName===null||n.propertyName.length===0)throw new Error("THREE.PropertyBinding: can not parse propertyName from trackName: "+t);return n}static findNode(t,e){if(e===void 0||e===""||e==="."||e===-1||e===t.name||e===t.uuid)return t;if(t.skeleton){let n=t.skeleton.getBoneByName(e);if(n!==void 0)return n}if(t.children){let n=function(r){for(let o=0;o<r.length;o++){let l=r[o];if(l.name===e||l.uuid===e)return l;let a=n(l.children);if(a)return a}return null},s=n(t.children);if(s)return s}return null}_getValue_unavailable(){}_setValue_unavailable(){}_getValue_direct(t,e){t[e]=this.targetObject[this.propertyName]}_getValue_array(t,e){let n=this.resolvedProperty;for(let s=0,r=n.length;s!==r;++s)t[e++]=n[s]}_getValue_arrayElement(t,e){t[e]=this.resolvedProperty[this.propertyIndex]}_getValue_toArray(t,e){this.resolvedProperty.toArray(t,e)}_setValue_direct(t,e){this.targetObject[this.propertyName]=t[e]}_setValue_direct_setNeedsUpdate(t,e){this.targetObject[this.propertyName]=t[e],this.targetObject.needsUpdate=!0}_setValue_direct_setMatrixWorldNeedsUpdate(t,e){this.targetObject[this.propertyName]=t[e],this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_array(t,e){let n=this.resolvedProperty;for(let s=0,r=n.length;s!==r;++s)n[s]=t[e++]}_setValue_array_setNeedsUpdate(t,e){let n=this.resolvedProperty;for(let s=0,r=n.length;s!==r;++s)n[s]=t[e++];this.targetObject.needsUpdate=!0}_setValue_array_setMatrixWorldNeedsUpdate(t,e){let n=this.resolvedProperty;for(let s=0,r=n.length;s!==r;++s)n[s]=t[e++];this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_arrayElement(t,e){this.resolvedProperty[this.propertyIndex]=t[e]}_setValue_arrayElement_setNeedsUpdate(t,e){this.resolvedProperty[this.propertyIndex]=t[e],this.targetObject.needsUpdate=!0}_setValue_arrayElement_setMatrixWorldNeedsUpdate(t,e){this.resolvedProperty[this.propertyIndex]=t[e],this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_fromArray(t,e){this.resolvedProperty.fromArray(t,e)}_setValue_fromArray_setNeedsUpdate(t,e){this.resolvedProperty.fromArray(t,e),this.targetObject.needsUpdate=!0}_setValue_fromArray_setMatrixWorldNeedsUpdate(t,e){this.resolvedProperty.fromArray(t,e),this.targetObject.matrixWorldNeedsUpdate=!0}_getValue_unbound(t,e){this.bind(),this.getValue(t,e)}_setValue_unbound(t,e){this.bind(),this.setValue(t,e)}bind(){let t=this.node,e=this.parsedPath,n=e.objectName,s=e.propertyName,r=e.propertyIndex;if(t||(t=i.findNode(this.rootNode,e.nodeName),this.node=t),this.getValue=this._getValue_unavailable,this.setValue=this._setValue_unavailable,!t){Rt("PropertyBinding: No target node found for track: "+this.path+".");return}if(n){let c=e.objectIndex;switch(n){case"materials":if(!t.material){Lt("PropertyBinding: Can not bind to material as node does not have a material.",this);return}if(!t.material.materials){Lt("PropertyBinding: Can not bind to material.materials as node.material does not have a materials array.",this);return}t=t.material.materials;break;case"bones":if(!t.skeleton){Lt("PropertyBinding: Can not bind to bones as node does not have a skeleton.",this);return}t=t.skeleton.bones;for(let u=0;u<t.length;u++)if(t[u].name===c){c=u;break}break;case"map":if("map"in t){t=t.map;break}if(!t.material){Lt("PropertyBinding: Can not bind to material as node does not have a material.",this);return}if(!t.material.map){Lt("PropertyBinding: Can not bind to material.map as node.material does not have a map.",this);return}t=t.material.map;break;default:if(t[n]===void 0){Lt("PropertyBinding: Can not bind to objectName of node undefined.",this);return}t=t[n]}if(c!==void 0){if(t[c]===void 0){Lt("PropertyBinding: Trying to bind to objectIndex of objectName, but is undefined.",this,t);return}t=t[c]}}let o=t[s];if(o===void 0){let c=e.nodeName;Lt("PropertyBinding: Trying to update property for track: "+c+"."+s+" but it wasn't found.",t);return}let l=this.Versioning.None;this.targetObject=t,t.isMaterial===!0?l=this.Versioning.NeedsUpdate:t.isObject3D===!0&&(l=this.Versioning.MatrixWorldNeedsUpdate);let a=this.BindingType.Direct;if(r!==void 0){if(s==="morphTargetInfluences"){if(!t.geometry){Lt("PropertyBinding: Can not bind to morphTargetInfluences because node does not have a geometry.",this);return}if(!t.geometry.morphAttributes){Lt("PropertyBinding: Can not bind to morphTargetInfluences because node does not have a geometry.morphAttributes.",this);return}t.morphTargetDictionary[r]!==void 0&&(r=t.morphTargetDictionary[r])}a=this.BindingType.ArrayElement,this.resolvedProperty=o,this.propertyIndex=r}else o.fromArray!==void 0&&o.toArray!==void 0?(a=this.BindingType.HasFromToArray,this.resolvedProperty=o):Array.isArray(o)?(a=this.BindingType.EntireArray,this.resolvedProperty=o):this.propertyName=s;this.getValue=this.GetterByBindingType[a],this.setValue=this.SetterByBindingTypeAndVersioning[a][l]}unbind(){this.node=null,this.getValue=this._getValue_unbound,this.setValue=this._setValue_unbound}};pe.Composite=gu;pe.prototype.BindingType={Direct:0,EntireArray:1,ArrayElement:2,HasFromToArray:3};pe.prototype.Versioning={None:0,NeedsUpdate:1,MatrixWorldNeedsUpdate:2};pe.prototype.GetterByBindingType=[pe.prototype._getValue_direct,pe.prototype._getValue_array,pe.prototype._getValue_arrayElement,pe.prototype._getValue_toArray];pe.prototype.SetterByBindingTypeAndVersioning=[[pe.prototype._setValue_direct,pe.prototype._setValue_direct_setNeedsUpdate,pe.prototype._setValue_direct_setMatrixWorldNeedsUpdate],[pe.prototype._setValue_array,pe.prototype._setValue_array_setNeedsUpdate,pe.prototype._setValue_array_setMatrixWorldNeedsUpdate],[pe.prototype._setValue_arrayElement,pe.prototype._setValue_arrayElement_setNeedsUpdate,pe.prototype._setValue_arrayElement_setMatrixWorldNeedsUpdate],[pe.prototype._setValue_fromArray,pe.prototype._setValue_fromArray_setNeedsUpdate,pe.prototype._setValue_fromArray_setMatrixWorldNeedsUpdate]];var ob=new Float32Array(1);var jf=new zt,Yr=class{constructor(t,e,n=0,s=1/0){this.ray=new In(t,e),this.near=n,this.far=s,this.camera=null,this.layers=new Ws,this.params={Mesh:{},Line:{threshold:1},LOD:{},Points:{threshold:1},Sprite:{}}}set(t,e){this.ray.set(t,e)}setFromCamera(t,e){e.isPerspectiveCamera?(this.ray.origin.setFromMatrixPosition(e.matrixWorld),this.ray.direction.set(t.x,t.y,.5).unproject(e).sub(this.ray.origin).normalize(),this.camera=e):e.isOrthographicCamera?(this.ray.origin.set(t.x,t.y,e.projectionMatrix.elements[14]).unproject(e),this.ray.direction.set(0,0,-1).transformDirection(e.matrixWorld),this.camera=e):Lt("Raycaster: Unsupported camera type: "+e.type)}setFromXRController(t){return jf.identity().extractRotation(t.matrixWorld),this.ray.origin.setFromMatrixPosition(t.matrixWorld),this.ray.direction.set(0,0,-1).applyMatrix4(jf),this}intersectObject(t,e=!0,n=[]){return xu(t,this,n,e),n.sort(td),n}intersectObjects(t,e=!0,n=[]){for(let s=0,r=t.length;s<r;s++)xu(t[s],this,n,e);return n.sort(td),n}};function td(i,t){return i.distance-t.distance}function xu(i,t,e,n){let s=!0;if(i.layers.test(t.layers)&&i.raycast(t,e)===!1&&(s=!1),s===!0&&n===!0){let r=i.children;for(let o=0,l=r.length;o<l;o++)xu(r[o],t,e,!0)}}var _u=class{static{this.prototype.isMatrix2=!0}constructor(t,e,n,s){this.elements=[1,0,0,1],t!==void 0&&this.set(t,e,n,s)}identity(){return this.set(1,0,0,1),this}fromArray(t,e=0){for(let n=0;n<4;n++)this.elements[n]=t[n+e];return this}set(t,e,n,s){let r=this.elements;return r[0]=t,r[2]=e,r[1]=n,r[3]=s,this}};var ed=new N,sa=new N,Os=new N,Bs=new N,hu=new N,n0=new N,i0=new N,an=class{constructor(t=new N,e=new N){this.start=t,this.end=e}set(t,e){return this.start.copy(t),this.end.copy(e),this}copy(t){return this.start.copy(t.start),this.end.copy(t.end),this}getCenter(t){return t.addVectors(this.start,this.end).multiplyScalar(.5)}delta(t){return t.subVectors(this.end,this.start)}distanceSq(){return this.start.distanceToSquared(this.end)}distance(){return this.start.distanceTo(this.end)}at(t,e){return this.delta(e).multiplyScalar(t).add(this.start)}closestPointToPointParameter(t,e){ed.subVectors(t,this.start),sa.subVectors(this.end,this.start);let n=sa.dot(sa);if(n===0)return 0;let r=sa.dot(ed)/n;return e&&(r=Bt(r,0,1)),r}closestPointToPoint(t,e,n){let s=this.closestPointToPointParameter(t,e);return this.delta(n).multiplyScalar(s).add(this.start)}distanceSqToLine3(t,e=n0,n=i0){let s=10000000000000001e-32,r,o,l=this.start,a=t.start,c=this.end,u=t.end;Os.subVectors(c,l),Bs.subVectors(u,a),hu.subVectors(l,a);let h=Os.dot(Os),f=Bs.dot(Bs),d=Bs.dot(hu);if(h<=s&&f<=s)return e.copy(l),n.copy(a),e.distanceToSquared(n);if(h<=s)r=0,o=d/f,o=Bt(o,0,1);else{let g=Os.dot(hu);if(f<=s)o=0,r=Bt(-g/h,0,1);else{let y=Os.dot(Bs),p=h*f-y*y;p!==0?r=Bt((y*d-g*f)/p,0,1):r=0,o=(y*r+d)/f,o<0?(o=0,r=Bt(-g/h,0,1)):o>1&&(o=1,r=Bt((y-g)/h,0,1))}}return e.copy(l).addScaledVector(Os,r),n.copy(a).addScaledVector(Bs,o),e.distanceToSquared(n)}applyMatrix4(t){return this.start.applyMatrix4(t),this.end.applyMatrix4(t),this}equals(t){return t.start.equals(this.start)&&t.end.equals(this.end)}clone(){return new this.constructor().copy(this)}};function Qu(i,t,e,n){let s=s0(n);switch(e){case Bu:return i*t;case ku:return i*t/s.components*s.byteLength;case qa:return i*t/s.components*s.byteLength;case Hi:return i*t*2/s.components*s.byteLength;case Ya:return i*t*2/s.components*s.byteLength;case zu:return i*t*3/s.components*s.byteLength;case Mn:return i*t*4/s.components*s.byteLength;case $a:return i*t*4/s.components*s.byteLength;case Jr:case Kr:return Math.floor((i+3)/4)*Math.floor((t+3)/4)*8;case Qr:case jr:return Math.floor((i+3)/4)*Math.floor((t+3)/4)*16;case Ja:case Qa:return Math.max(i,16)*Math.max(t,8)/4;case Za:case Ka:return Math.max(i,8)*Math.max(t,8)/2;case ja:case tl:case nl:case il:return Math.floor((i+3)/4)*Math.floor((t+3)/4)*8;case el:case to:case sl:return Math.floor((i+3)/4)*Math.floor((t+3)/4)*16;case rl:return Math.floor((i+3)/4)*Math.floor((t+3)/4)*16;case ol:return Math.floor((i+4)/5)*Math.floor((t+3)/4)*16;case al:return Math.floor((i+4)/5)*Math.floor((t+4)/5)*16;case ll:return Math.floor((i+5)/6)*Math.floor((t+4)/5)*16;case cl:return Math.floor((i+5)/6)*Math.floor((t+5)/6)*16;case ul:return Math.floor((i+7)/8)*Math.floor((t+4)/5)*16;case hl:return Math.floor((i+7)/8)*Math.floor((t+5)/6)*16;case fl:return Math.floor((i+7)/8)*Math.floor((t+7)/8)*16;case dl:return Math.floor((i+9)/10)*Math.floor((t+4)/5)*16;case pl:return Math.floor((i+9)/10)*Math.floor((t+5)/6)*16;case ml:return Math.floor((i+9)/10)*Math.floor((t+7)/8)*16;case gl:return Math.floor((i+9)/10)*Math.floor((t+9)/10)*16;case xl:return Math.floor((i+11)/12)*Math.floor((t+9)/10)*16;case _l:return Math.floor((i+11)/12)*Math.floor((t+11)/12)*16;case yl:case vl:case Ml:return Math.ceil(i/4)*Math.ceil(t/4)*16;case Sl:case bl:return Math.ceil(i/4)*Math.ceil(t/4)*8;case eo:case wl:return Math.ceil(i/4)*Math.ceil(t/4)*16}throw new Error(`Unable to determine texture byte length for ${e} format.`)}function s0(i){switch(i){case ln:case Du:return{byteLength:1,components:1};case Qs:case Uu:case Wn:return{byteLength:2,components:1};case Wa:case Xa:return{byteLength:2,components:4};case Gn:case Ha:case Hn:return{byteLength:4,components:1};case Fu:case Ou:return{byteLength:4,components:3}}throw new Error(`THREE.TextureUtils: Unknown texture type ${i}.`)}typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("register",{detail:{revision:"187"}}));typeof window<"u"&&(window.__THREE__?Rt("WARNING: Multiple instances of Three.js being imported."):window.__THREE__="187");function up(){let i=null,t=!1,e=null,n=null;function s(r,o){n=i.requestAnimationFrame(s),e(r,o)}return{start:function(){t!==!0&&e!==null&&i!==null&&(n=i.requestAnimationFrame(s),t=!0)},stop:function(){i!==null&&i.cancelAnimationFrame(n),t=!1},setAnimationLoop:function(r){e=r},setContext:function(r){i=r}}}function r0(i){let t=new WeakMap;function e(l,a){let c=l.array,u=l.usage,h=c.byteLength,f=i.createBuffer();i.bindBuffer(a,f),i.bufferData(a,c,u),l.onUploadCallback();let d;if(c instanceof Float32Array)d=i.FLOAT;else if(typeof Float16Array<"u"&&c instanceof Float16Array)d=i.HALF_FLOAT;else if(c instanceof Uint16Array)l.isFloat16BufferAttribute?d=i.HALF_FLOAT:d=i.UNSIGNED_SHORT;else if(c instanceof Int16Array)d=i.SHORT;else if(c instanceof Uint32Array)d=i.UNSIGNED_INT;else if(c instanceof Int32Array)d=i.INT;else if(c instanceof Int8Array)d=i.BYTE;else if(c instanceof Uint8Array)d=i.UNSIGNED_BYTE;else if(c instanceof Uint8ClampedArray)d=i.UNSIGNED_BYTE;else throw new Error("THREE.WebGLAttributes: Unsupported buffer data format: "+c);return{buffer:f,type:d,bytesPerElement:c.BYTES_PER_ELEMENT,version:l.version,size:h}}function n(l,a,c){let u=a.array,h=a.updateRanges;if(i.bindBuffer(c,l),h.length===0)i.bufferSubData(c,0,u);else{h.sort((d,g)=>d.start-g.start);let f=0;for(let d=1;d<h.length;d++){let g=h[f],y=h[d];y.start<=g.start+g.count+1?g.count=Math.max(g.count,y.start+y.count-g.start):(++f,h[f]=y)}h.length=f+1;for(let d=0,g=h.length;d<g;d++){let y=h[d];i.bufferSubData(c,y.start*u.BYTES_PER_ELEMENT,u,y.start,y.count)}a.clearUpdateRanges()}a.onUploadCallback()}function s(l){return l.isInterleavedBufferAttribute&&(l=l.data),t.get(l)}function r(l){l.isInterleavedBufferAttribute&&(l=l.data);let a=t.get(l);a&&(i.deleteBuffer(a.buffer),t.delete(l))}function o(l,a){if(l.isInterleavedBufferAttribute&&(l=l.data),l.isGLBufferAttribute){let u=t.get(l);(!u||u.version<l.version)&&t.set(l,{buffer:l.buffer,type:l.type,bytesPerElement:l.elementSize,version:l.version});return}let c=t.get(l);if(c===void 0)t.set(l,e(l,a));else if(c.version<l.version){if(c.size!==l.array.byteLength)throw new Error("THREE.WebGLAttributes: The size of the buffer attribute's array buffer does not match the original size. Resizing buffer attributes is not supported.");n(c.buffer,l,a),c.version=l.version}}return{get:s,remove:r,update:o}}var o0=`#ifdef USE_ALPHAHASH
	if ( diffuseColor.a < getAlphaHashThreshold( vPosition ) ) discard;
#endif`,a0=`#ifdef USE_ALPHAHASH
	const float ALPHA_HASH_SCALE = 0.05;
	float hash2D( vec2 value ) {
		return fract( 1.0e4 * sin( 17.0 * value.x + 0.1 * value.y ) * ( 0.1 + abs( sin( 13.0 * value.y + value.x ) ) ) );
	}
	float hash3D( vec3 value ) {
		return hash2D( vec2( hash2D( value.xy ), value.z ) );
	}
	float getAlphaHashThreshold( vec3 position ) {
		float maxDeriv = max(
			length( dFdx( position.xyz ) ),
			length( dFdy( position.xyz ) )
		);
		float pixScale = 1.0 / ( ALPHA_HASH_SCALE * maxDeriv );
		vec2 pixScales = vec2(
			exp2( floor( log2( pixScale ) ) ),
			exp2( ceil( log2( pixScale ) ) )
		);
		vec2 alpha = vec2(
			hash3D( floor( pixScales.x * position.xyz ) ),
			hash3D( floor( pixScales.y * position.xyz ) )
		);
		float lerpFactor = fract( log2( pixScale ) );
		float x = ( 1.0 - lerpFactor ) * alpha.x + lerpFactor * alpha.y;
		float a = min( lerpFactor, 1.0 - lerpFactor );
		vec3 cases = vec3(
			x * x / ( 2.0 * a * ( 1.0 - a ) ),
			( x - 0.5 * a ) / ( 1.0 - a ),
			1.0 - ( ( 1.0 - x ) * ( 1.0 - x ) / ( 2.0 * a * ( 1.0 - a ) ) )
		);
		float threshold = ( x < ( 1.0 - a ) )
			? ( ( x < a ) ? cases.x : cases.y )
			: cases.z;
		return clamp( threshold , 1.0e-6, 1.0 );
	}
#endif`,l0=`#ifdef USE_ALPHAMAP
	diffuseColor.a *= texture2D( alphaMap, vAlphaMapUv ).g;
#endif`,c0=`#ifdef USE_ALPHAMAP
	uniform sampler2D alphaMap;
#endif`,u0=`#ifdef USE_ALPHATEST
	#ifdef ALPHA_TO_COVERAGE
	diffuseColor.a = smoothstep( alphaTest, alphaTest + fwidth( diffuseColor.a ), diffuseColor.a );
	if ( diffuseColor.a == 0.0 ) discard;
	#else
	if ( diffuseColor.a < alphaTest ) discard;
	#endif
#endif`,h0=`#ifdef USE_ALPHATEST
	uniform float alphaTest;
#endif`,f0=`#ifdef USE_AOMAP
	float ambientOcclusion = ( texture2D( aoMap, vAoMapUv ).r - 1.0 ) * aoMapIntensity + 1.0;
	reflectedLight.indirectDiffuse *= ambientOcclusion;
	#if defined( USE_CLEARCOAT ) 
		clearcoatSpecularIndirect *= ambientOcclusion;
	#endif
	#if defined( USE_SHEEN ) 
		sheenSpecularIndirect *= ambientOcclusion;
	#endif
	#if defined( USE_ENVMAP ) && defined( STANDARD )
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		reflectedLight.indirectSpecular *= computeSpecularOcclusion( dotNV, ambientOcclusion, material.roughness );
	#endif
#endif`,d0=`#ifdef USE_AOMAP
	uniform sampler2D aoMap;
	uniform float aoMapIntensity;
#endif`,p0=`#ifdef USE_BATCHING
	#if ! defined( GL_ANGLE_multi_draw )
	#define gl_DrawID _gl_DrawID
	uniform int _gl_DrawID;
	#endif
	uniform highp sampler2D batchingTexture;
	uniform highp usampler2D batchingIdTexture;
	mat4 getBatchingMatrix( const in float i ) {
		int size = textureSize( batchingTexture, 0 ).x;
		int j = int( i ) * 4;
		int x = j % size;
		int y = j / size;
		vec4 v1 = texelFetch( batchingTexture, ivec2( x, y ), 0 );
		vec4 v2 = texelFetch( batchingTexture, ivec2( x + 1, y ), 0 );
		vec4 v3 = texelFetch( batchingTexture, ivec2( x + 2, y ), 0 );
		vec4 v4 = texelFetch( batchingTexture, ivec2( x + 3, y ), 0 );
		return mat4( v1, v2, v3, v4 );
	}
	float getIndirectIndex( const in int i ) {
		int size = textureSize( batchingIdTexture, 0 ).x;
		int x = i % size;
		int y = i / size;
		return float( texelFetch( batchingIdTexture, ivec2( x, y ), 0 ).r );
	}
#endif
#ifdef USE_BATCHING_COLOR
	uniform sampler2D batchingColorTexture;
	vec4 getBatchingColor( const in float i ) {
		int size = textureSize( batchingColorTexture, 0 ).x;
		int j = int( i );
		int x = j % size;
		int y = j / size;
		return texelFetch( batchingColorTexture, ivec2( x, y ), 0 );
	}
#endif`,m0=`#ifdef USE_BATCHING
	mat4 batchingMatrix = getBatchingMatrix( getIndirectIndex( gl_DrawID ) );
#endif`,g0=`vec3 transformed = vec3( position );
#ifdef USE_ALPHAHASH
	vPosition = vec3( position );
#endif`,x0=`vec3 objectNormal = vec3( normal );
#ifdef USE_TANGENT
	vec3 objectTangent = vec3( tangent.xyz );
#endif`,_0=`float G_BlinnPhong_Implicit( ) {
	return 0.25;
}
float D_BlinnPhong( const in float shininess, const in float dotNH ) {
	return RECIPROCAL_PI * ( shininess * 0.5 + 1.0 ) * pow( dotNH, shininess );
}
vec3 BRDF_BlinnPhong( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in vec3 specularColor, const in float shininess ) {
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNH = saturate( dot( normal, halfDir ) );
	float dotVH = saturate( dot( viewDir, halfDir ) );
	vec3 F = F_Schlick( specularColor, 1.0, dotVH );
	float G = G_BlinnPhong_Implicit( );
	float D = D_BlinnPhong( shininess, dotNH );
	return F * ( G * D );
} // validated`,y0=`#ifdef USE_IRIDESCENCE
	const mat3 XYZ_TO_REC709 = mat3(
		 3.2404542, -0.9692660,  0.0556434,
		-1.5371385,  1.8760108, -0.2040259,
		-0.4985314,  0.0415560,  1.0572252
	);
	vec3 Fresnel0ToIor( vec3 fresnel0 ) {
		vec3 sqrtF0 = sqrt( fresnel0 );
		return ( vec3( 1.0 ) + sqrtF0 ) / ( vec3( 1.0 ) - sqrtF0 );
	}
	vec3 IorToFresnel0( vec3 transmittedIor, float incidentIor ) {
		return pow2( ( transmittedIor - vec3( incidentIor ) ) / ( transmittedIor + vec3( incidentIor ) ) );
	}
	float IorToFresnel0( float transmittedIor, float incidentIor ) {
		return pow2( ( transmittedIor - incidentIor ) / ( transmittedIor + incidentIor ));
	}
	vec3 evalSensitivity( float OPD, vec3 shift ) {
		float phase = 2.0 * PI * OPD * 1.0e-9;
		vec3 val = vec3( 5.4856e-13, 4.4201e-13, 5.2481e-13 );
		vec3 pos = vec3( 1.6810e+06, 1.7953e+06, 2.2084e+06 );
		vec3 var = vec3( 4.3278e+09, 9.3046e+09, 6.6121e+09 );
		vec3 xyz = val * sqrt( 2.0 * PI * var ) * cos( pos * phase + shift ) * exp( - pow2( phase ) * var );
		xyz.x += 9.7470e-14 * sqrt( 2.0 * PI * 4.5282e+09 ) * cos( 2.2399e+06 * phase + shift[ 0 ] ) * exp( - 4.5282e+09 * pow2( phase ) );
		xyz /= 1.0685e-7;
		vec3 rgb = XYZ_TO_REC709 * xyz;
		return rgb;
	}
	vec3 evalIridescence( float outsideIOR, float eta2, float cosTheta1, float thinFilmThickness, vec3 baseF0 ) {
		vec3 I;
		float iridescenceIOR = mix( outsideIOR, eta2, smoothstep( 0.0, 0.03, thinFilmThickness ) );
		float sinTheta2Sq = pow2( outsideIOR / iridescenceIOR ) * ( 1.0 - pow2( cosTheta1 ) );
		float cosTheta2Sq = 1.0 - sinTheta2Sq;
		if ( cosTheta2Sq < 0.0 ) {
			return vec3( 1.0 );
		}
		float cosTheta2 = sqrt( cosTheta2Sq );
		float R0 = IorToFresnel0( iridescenceIOR, outsideIOR );
		float R12 = F_Schlick( R0, 1.0, cosTheta1 );
		float T121 = 1.0 - R12;
		float phi12 = 0.0;
		if ( iridescenceIOR < outsideIOR ) phi12 = PI;
		float phi21 = PI - phi12;
		vec3 baseIOR = Fresnel0ToIor( clamp( baseF0, 0.0, 0.9999 ) );		vec3 R1 = IorToFresnel0( baseIOR, iridescenceIOR );
		vec3 R23 = F_Schlick( R1, 1.0, cosTheta2 );
		vec3 phi23 = vec3( 0.0 );
		if ( baseIOR[ 0 ] < iridescenceIOR ) phi23[ 0 ] = PI;
		if ( baseIOR[ 1 ] < iridescenceIOR ) phi23[ 1 ] = PI;
		if ( baseIOR[ 2 ] < iridescenceIOR ) phi23[ 2 ] = PI;
		float OPD = 2.0 * iridescenceIOR * thinFilmThickness * cosTheta2;
		vec3 phi = vec3( phi21 ) + phi23;
		vec3 R123 = clamp( R12 * R23, 1e-5, 0.9999 );
		vec3 r123 = sqrt( R123 );
		vec3 Rs = pow2( T121 ) * R23 / ( vec3( 1.0 ) - R123 );
		vec3 C0 = R12 + Rs;
		I = C0;
		vec3 Cm = Rs - T121;
		for ( int m = 1; m <= 2; ++ m ) {
			Cm *= r123;
			vec3 Sm = 2.0 * evalSensitivity( float( m ) * OPD, float( m ) * phi );
			I += Cm * Sm;
		}
		return max( I, vec3( 0.0 ) );
	}
#endif`,v0=`#ifdef USE_BUMPMAP
	uniform sampler2D bumpMap;
	uniform float bumpScale;
	vec2 dHdxy_fwd() {
		vec2 dSTdx = dFdx( vBumpMapUv );
		vec2 dSTdy = dFdy( vBumpMapUv );
		float Hll = bumpScale * texture2D( bumpMap, vBumpMapUv ).x;
		float dBx = bumpScale * texture2D( bumpMap, vBumpMapUv + dSTdx ).x - Hll;
		float dBy = bumpScale * texture2D( bumpMap, vBumpMapUv + dSTdy ).x - Hll;
		return vec2( dBx, dBy );
	}
	vec3 perturbNormalArb( vec3 surf_pos, vec3 surf_norm, vec2 dHdxy, float faceDirection ) {
		vec3 vSigmaX = normalize( dFdx( surf_pos.xyz ) );
		vec3 vSigmaY = normalize( dFdy( surf_pos.xyz ) );
		vec3 vN = surf_norm;
		vec3 R1 = cross( vSigmaY, vN );
		vec3 R2 = cross( vN, vSigmaX );
		float fDet = dot( vSigmaX, R1 ) * faceDirection;
		vec3 vGrad = sign( fDet ) * ( dHdxy.x * R1 + dHdxy.y * R2 );
		return normalize( abs( fDet ) * surf_norm - vGrad );
	}
#endif`,M0=`#if NUM_CLIPPING_PLANES > 0
	vec4 plane;
	#ifdef ALPHA_TO_COVERAGE
		float distanceToPlane, distanceGradient;
		float clipOpacity = 1.0;
		#pragma unroll_loop_start
		for ( int i = 0; i < UNION_CLIPPING_PLANES; i ++ ) {
			plane = clippingPlanes[ i ];
			distanceToPlane = - dot( vClipPosition, plane.xyz ) + plane.w;
			distanceGradient = fwidth( distanceToPlane ) / 2.0;
			clipOpacity *= smoothstep( - distanceGradient, distanceGradient, distanceToPlane );
			if ( clipOpacity == 0.0 ) discard;
		}
		#pragma unroll_loop_end
		#if UNION_CLIPPING_PLANES < NUM_CLIPPING_PLANES
			float unionClipOpacity = 1.0;
			#pragma unroll_loop_start
			for ( int i = UNION_CLIPPING_PLANES; i < NUM_CLIPPING_PLANES; i ++ ) {
				plane = clippingPlanes[ i ];
				distanceToPlane = - dot( vClipPosition, plane.xyz ) + plane.w;
				distanceGradient = fwidth( distanceToPlane ) / 2.0;
				unionClipOpacity *= 1.0 - smoothstep( - distanceGradient, distanceGradient, distanceToPlane );
			}
			#pragma unroll_loop_end
			clipOpacity *= 1.0 - unionClipOpacity;
		#endif
		diffuseColor.a *= clipOpacity;
		if ( diffuseColor.a == 0.0 ) discard;
	#else
		#pragma unroll_loop_start
		for ( int i = 0; i < UNION_CLIPPING_PLANES; i ++ ) {
			plane = clippingPlanes[ i ];
			if ( dot( vClipPosition, plane.xyz ) > plane.w ) discard;
		}
		#pragma unroll_loop_end
		#if UNION_CLIPPING_PLANES < NUM_CLIPPING_PLANES
			bool clipped = true;
			#pragma unroll_loop_start
			for ( int i = UNION_CLIPPING_PLANES; i < NUM_CLIPPING_PLANES; i ++ ) {
				plane = clippingPlanes[ i ];
				clipped = ( dot( vClipPosition, plane.xyz ) > plane.w ) && clipped;
			}
			#pragma unroll_loop_end
			if ( clipped ) discard;
		#endif
	#endif
#endif`,S0=`#if NUM_CLIPPING_PLANES > 0
	varying vec3 vClipPosition;
	uniform vec4 clippingPlanes[ NUM_CLIPPING_PLANES ];
#endif`,b0=`#if NUM_CLIPPING_PLANES > 0
	varying vec3 vClipPosition;
#endif`,w0=`#if NUM_CLIPPING_PLANES > 0
	vClipPosition = - mvPosition.xyz;
#endif`,A0=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA )
	diffuseColor *= vColor;
#endif`,T0=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA )
	varying vec4 vColor;
#endif`,E0=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA ) || defined( USE_INSTANCING_COLOR ) || defined( USE_BATCHING_COLOR )
	varying vec4 vColor;
#endif`,R0=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA ) || defined( USE_INSTANCING_COLOR ) || defined( USE_BATCHING_COLOR )
	vColor = vec4( 1.0 );
#endif
#ifdef USE_COLOR_ALPHA
	vColor *= color;
#elif defined( USE_COLOR )
	vColor.rgb *= color;
#endif
#ifdef USE_INSTANCING_COLOR
	vColor.rgb *= instanceColor.rgb;
#endif
#ifdef USE_BATCHING_COLOR
	vColor *= getBatchingColor( getIndirectIndex( gl_DrawID ) );
#endif`,C0=`#define PI 3.141592653589793
#define PI2 6.283185307179586
#define PI_HALF 1.5707963267948966
#define RECIPROCAL_PI 0.3183098861837907
#define RECIPROCAL_PI2 0.15915494309189535
#define EPSILON 1e-6
#ifndef saturate
#define saturate( a ) clamp( a, 0.0, 1.0 )
#endif
#define whiteComplement( a ) ( 1.0 - saturate( a ) )
float pow2( const in float x ) { return x*x; }
vec3 pow2( const in vec3 x ) { return x*x; }
float pow3( const in float x ) { return x*x*x; }
float pow4( const in float x ) { float x2 = x*x; return x2*x2; }
float max3( const in vec3 v ) { return max( max( v.x, v.y ), v.z ); }
float average( const in vec3 v ) { return dot( v, vec3( 0.3333333 ) ); }
highp float rand( const in vec2 uv ) {
	const highp float a = 12.9898, b = 78.233, c = 43758.5453;
	highp float dt = dot( uv.xy, vec2( a,b ) ), sn = mod( dt, PI );
	return fract( sin( sn ) * c );
}
#ifdef HIGH_PRECISION
	float precisionSafeLength( vec3 v ) { return length( v ); }
#else
	float precisionSafeLength( vec3 v ) {
		float maxComponent = max3( abs( v ) );
		return length( v / maxComponent ) * maxComponent;
	}
#endif
struct IncidentLight {
	vec3 color;
	vec3 direction;
	bool visible;
};
struct ReflectedLight {
	vec3 directDiffuse;
	vec3 directSpecular;
	vec3 indirectDiffuse;
	vec3 indirectSpecular;
};
#ifdef USE_ALPHAHASH
	varying vec3 vPosition;
#endif
vec3 transformDirection( in vec3 dir, in mat4 matrix ) {
	return normalize( ( matrix * vec4( dir, 0.0 ) ).xyz );
}
#define inverseTransformDirection transformDirectionByInverseViewMatrix
vec3 transformNormalByInverseViewMatrix( in vec3 normal, in mat4 viewMatrix ) {
	return normalize( ( vec4( normal, 0.0 ) * viewMatrix ).xyz );
}
vec3 transformDirectionByInverseViewMatrix( in vec3 dir, in mat4 viewMatrix ) {
	return normalize( ( vec4( dir, 0.0 ) * viewMatrix ).xyz );
}
bool isPerspectiveMatrix( mat4 m ) {
	return m[ 2 ][ 3 ] == - 1.0;
}
vec2 equirectUv( in vec3 dir ) {
	float u = atan( dir.z, dir.x ) * RECIPROCAL_PI2 + 0.5;
	float v = asin( clamp( dir.y, - 1.0, 1.0 ) ) * RECIPROCAL_PI + 0.5;
	return vec2( u, v );
}
vec3 BRDF_Lambert( const in vec3 diffuseColor ) {
	return RECIPROCAL_PI * diffuseColor;
}
vec3 F_Schlick( const in vec3 f0, const in float f90, const in float dotVH ) {
	float fresnel = exp2( ( - 5.55473 * dotVH - 6.98316 ) * dotVH );
	return f0 * ( 1.0 - fresnel ) + ( f90 * fresnel );
}
float F_Schlick( const in float f0, const in float f90, const in float dotVH ) {
	float fresnel = exp2( ( - 5.55473 * dotVH - 6.98316 ) * dotVH );
	return f0 * ( 1.0 - fresnel ) + ( f90 * fresnel );
} // validated`,P0=`vec3 transformedNormal = objectNormal;
#ifdef USE_TANGENT
	vec3 transformedTangent = objectTangent;
#endif
#ifdef USE_BATCHING
	mat3 bm = mat3( batchingMatrix );
	transformedNormal /= vec3( dot( bm[ 0 ], bm[ 0 ] ), dot( bm[ 1 ], bm[ 1 ] ), dot( bm[ 2 ], bm[ 2 ] ) );
	transformedNormal = bm * transformedNormal;
	#ifdef USE_TANGENT
		transformedTangent = bm * transformedTangent;
	#endif
#endif
#ifdef USE_INSTANCING
	mat3 im = mat3( instanceMatrix );
	transformedNormal /= vec3( dot( im[ 0 ], im[ 0 ] ), dot( im[ 1 ], im[ 1 ] ), dot( im[ 2 ], im[ 2 ] ) );
	transformedNormal = im * transformedNormal;
	#ifdef USE_TANGENT
		transformedTangent = im * transformedTangent;
	#endif
#endif
transformedNormal = normalMatrix * transformedNormal;
#ifdef FLIP_SIDED
	transformedNormal = - transformedNormal;
#endif
#ifdef USE_TANGENT
	transformedTangent = ( modelViewMatrix * vec4( transformedTangent, 0.0 ) ).xyz;
#endif`,I0=`#ifdef USE_DISPLACEMENTMAP
	uniform sampler2D displacementMap;
	uniform float displacementScale;
	uniform float displacementBias;
#endif`,L0=`#ifdef USE_DISPLACEMENTMAP
	transformed += normalize( objectNormal ) * ( texture2D( displacementMap, vDisplacementMapUv ).x * displacementScale + displacementBias );
#endif`,N0=`#ifdef USE_EMISSIVEMAP
	vec4 emissiveColor = texture2D( emissiveMap, vEmissiveMapUv );
	#ifdef DECODE_VIDEO_TEXTURE_EMISSIVE
		emissiveColor = sRGBTransferEOTF( emissiveColor );
	#endif
	totalEmissiveRadiance *= emissiveColor.rgb;
#endif`,D0=`#ifdef USE_EMISSIVEMAP
	uniform sampler2D emissiveMap;
#endif`,U0="gl_FragColor = linearToOutputTexel( gl_FragColor );",F0=`vec4 LinearTransferOETF( in vec4 value ) {
	return value;
}
vec4 sRGBTransferEOTF( in vec4 value ) {
	return vec4( mix( pow( value.rgb * 0.9478672986 + vec3( 0.0521327014 ), vec3( 2.4 ) ), value.rgb * 0.0773993808, vec3( lessThanEqual( value.rgb, vec3( 0.04045 ) ) ) ), value.a );
}
vec4 sRGBTransferOETF( in vec4 value ) {
	return vec4( mix( pow( value.rgb, vec3( 0.41666 ) ) * 1.055 - vec3( 0.055 ), value.rgb * 12.92, vec3( lessThanEqual( value.rgb, vec3( 0.0031308 ) ) ) ), value.a );
}`,O0=`#ifdef USE_ENVMAP
	#ifdef ENV_WORLDPOS
		vec3 cameraToFrag;
		if ( isOrthographic ) {
			cameraToFrag = normalize( vec3( - viewMatrix[ 0 ][ 2 ], - viewMatrix[ 1 ][ 2 ], - viewMatrix[ 2 ][ 2 ] ) );
		} else {
			cameraToFrag = normalize( vWorldPosition - cameraPosition );
		}
		vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
		#ifdef ENVMAP_MODE_REFLECTION
			vec3 reflectVec = reflect( cameraToFrag, worldNormal );
		#else
			vec3 reflectVec = refract( cameraToFrag, worldNormal, refractionRatio );
		#endif
	#else
		vec3 reflectVec = vReflect;
	#endif
	#ifdef ENVMAP_TYPE_CUBE
		vec4 envColor = textureCube( envMap, envMapRotation * reflectVec );
		#ifdef ENVMAP_BLENDING_MULTIPLY
			outgoingLight = mix( outgoingLight, outgoingLight * envColor.xyz, specularStrength * reflectivity );
		#elif defined( ENVMAP_BLENDING_MIX )
			outgoingLight = mix( outgoingLight, envColor.xyz, specularStrength * reflectivity );
		#elif defined( ENVMAP_BLENDING_ADD )
			outgoingLight += envColor.xyz * specularStrength * reflectivity;
		#endif
	#endif
#endif`,B0=`#ifdef USE_ENVMAP
	uniform float envMapIntensity;
	uniform mat3 envMapRotation;
	uniform samplerCube envMap;
	#ifdef ENVMAP_TYPE_PMREM
		float roughnessToMip( const in float roughness ) {
			float r = clamp( roughness, 0.0, 1.0 );
			return ENVMAP_MAX_LOD * r * ( 2.0 - r );
		}
	#endif
#endif`,z0=`#ifdef USE_ENVMAP
	uniform float reflectivity;
	#if defined( USE_BUMPMAP ) || defined( USE_NORMALMAP ) || defined( PHONG ) || defined( LAMBERT )
		#define ENV_WORLDPOS
	#endif
	#ifdef ENV_WORLDPOS
		varying vec3 vWorldPosition;
		uniform float refractionRatio;
	#else
		varying vec3 vReflect;
	#endif
#endif`,k0=`#ifdef USE_ENVMAP
	#if defined( USE_BUMPMAP ) || defined( USE_NORMALMAP ) || defined( PHONG ) || defined( LAMBERT )
		#define ENV_WORLDPOS
	#endif
	#ifdef ENV_WORLDPOS
		
		varying vec3 vWorldPosition;
	#else
		varying vec3 vReflect;
		uniform float refractionRatio;
	#endif
#endif`,V0=`#ifdef USE_ENVMAP
	#ifdef ENV_WORLDPOS
		vWorldPosition = worldPosition.xyz;
	#else
		vec3 cameraToVertex;
		if ( isOrthographic ) {
			cameraToVertex = normalize( vec3( - viewMatrix[ 0 ][ 2 ], - viewMatrix[ 1 ][ 2 ], - viewMatrix[ 2 ][ 2 ] ) );
		} else {
			cameraToVertex = normalize( worldPosition.xyz - cameraPosition );
		}
		vec3 worldNormal = transformNormalByInverseViewMatrix( transformedNormal, viewMatrix );
		#ifdef ENVMAP_MODE_REFLECTION
			vReflect = reflect( cameraToVertex, worldNormal );
		#else
			vReflect = refract( cameraToVertex, worldNormal, refractionRatio );
		#endif
	#endif
#endif`,G0=`#ifdef USE_FOG
	vFogDepth = - mvPosition.z;
#endif`,H0=`#ifdef USE_FOG
	varying float vFogDepth;
#endif`,W0=`#ifdef USE_FOG
	#ifdef FOG_EXP2
		float fogFactor = 1.0 - exp( - fogDensity * fogDensity * vFogDepth * vFogDepth );
	#else
		float fogFactor = smoothstep( fogNear, fogFar, vFogDepth );
	#endif
	gl_FragColor.rgb = mix( gl_FragColor.rgb, fogColor, fogFactor );
#endif`,X0=`#ifdef USE_FOG
	uniform vec3 fogColor;
	varying float vFogDepth;
	#ifdef FOG_EXP2
		uniform float fogDensity;
	#else
		uniform float fogNear;
		uniform float fogFar;
	#endif
#endif`,q0=`#ifdef USE_GRADIENTMAP
	uniform sampler2D gradientMap;
#endif
vec3 getGradientIrradiance( vec3 normal, vec3 lightDirection ) {
	float dotNL = dot( normal, lightDirection );
	vec2 coord = vec2( dotNL * 0.5 + 0.5, 0.0 );
	#ifdef USE_GRADIENTMAP
		return vec3( texture2D( gradientMap, coord ).r );
	#else
		vec2 fw = fwidth( coord ) * 0.5;
		return mix( vec3( 0.7 ), vec3( 1.0 ), smoothstep( 0.7 - fw.x, 0.7 + fw.x, coord.x ) );
	#endif
}`,Y0=`#ifdef USE_LIGHTMAP
	uniform sampler2D lightMap;
	uniform float lightMapIntensity;
#endif`,$0=`LambertMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.specularStrength = specularStrength;`,Z0=`varying vec3 vViewPosition;
struct LambertMaterial {
	vec3 diffuseColor;
	float specularStrength;
};
void RE_Direct_Lambert( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in LambertMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectDiffuse_Lambert( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in LambertMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_Lambert
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Lambert`,J0=`uniform bool receiveShadow;
uniform vec3 ambientLightColor;
#if defined( USE_LIGHT_PROBES )
	uniform vec3 lightProbe[ 9 ];
#endif
vec3 shGetIrradianceAt( in vec3 normal, in vec3 shCoefficients[ 9 ] ) {
	float x = normal.x, y = normal.y, z = normal.z;
	vec3 result = shCoefficients[ 0 ] * 0.886227;
	result += shCoefficients[ 1 ] * 2.0 * 0.511664 * y;
	result += shCoefficients[ 2 ] * 2.0 * 0.511664 * z;
	result += shCoefficients[ 3 ] * 2.0 * 0.511664 * x;
	result += shCoefficients[ 4 ] * 2.0 * 0.429043 * x * y;
	result += shCoefficients[ 5 ] * 2.0 * 0.429043 * y * z;
	result += shCoefficients[ 6 ] * ( 0.743125 * z * z - 0.247708 );
	result += shCoefficients[ 7 ] * 2.0 * 0.429043 * x * z;
	result += shCoefficients[ 8 ] * 0.429043 * ( x * x - y * y );
	return result;
}
vec3 getLightProbeIrradiance( const in vec3 lightProbe[ 9 ], const in vec3 normal ) {
	vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
	vec3 irradiance = shGetIrradianceAt( worldNormal, lightProbe );
	return irradiance;
}
vec3 getAmbientLightIrradiance( const in vec3 ambientLightColor ) {
	vec3 irradiance = ambientLightColor;
	return irradiance;
}
float getDistanceAttenuation( const in float lightDistance, const in float cutoffDistance, const in float decayExponent ) {
	float distanceFalloff = 1.0 / max( pow( lightDistance, decayExponent ), 0.01 );
	if ( cutoffDistance > 0.0 ) {
		distanceFalloff *= pow2( saturate( 1.0 - pow4( lightDistance / cutoffDistance ) ) );
	}
	return distanceFalloff;
}
float getSpotAttenuation( const in float coneCosine, const in float penumbraCosine, const in float angleCosine ) {
	return smoothstep( coneCosine, penumbraCosine, angleCosine );
}
#if NUM_SUN_LIGHTS > 0
	struct SunLight {
		vec3 direction;
		vec3 color;
	};
	uniform SunLight sunLights[ NUM_SUN_LIGHTS ];
	void getSunLightInfo( const in SunLight sunLight, out IncidentLight light ) {
		light.color = sunLight.color;
		light.direction = sunLight.direction;
		light.visible = true;
	}
#endif
#if NUM_DIR_LIGHTS > 0
	struct DirectionalLight {
		vec3 direction;
		vec3 color;
	};
	uniform DirectionalLight directionalLights[ NUM_DIR_LIGHTS ];
	void getDirectionalLightInfo( const in DirectionalLight directionalLight, out IncidentLight light ) {
		light.color = directionalLight.color;
		light.direction = directionalLight.direction;
		light.visible = true;
	}
#endif
#if NUM_POINT_LIGHTS > 0
	struct PointLight {
		vec3 position;
		vec3 color;
		float distance;
		float decay;
	};
	uniform PointLight pointLights[ NUM_POINT_LIGHTS ];
	void getPointLightInfo( const in PointLight pointLight, const in vec3 geometryPosition, out IncidentLight light ) {
		vec3 lVector = pointLight.position - geometryPosition;
		light.direction = normalize( lVector );
		float lightDistance = length( lVector );
		light.color = pointLight.color;
		light.color *= getDistanceAttenuation( lightDistance, pointLight.distance, pointLight.decay );
		light.visible = ( light.color != vec3( 0.0 ) );
	}
#endif
#if NUM_SPOT_LIGHTS > 0
	struct SpotLight {
		vec3 position;
		vec3 direction;
		vec3 color;
		float distance;
		float decay;
		float coneCos;
		float penumbraCos;
	};
	uniform SpotLight spotLights[ NUM_SPOT_LIGHTS ];
	void getSpotLightInfo( const in SpotLight spotLight, const in vec3 geometryPosition, out IncidentLight light ) {
		vec3 lVector = spotLight.position - geometryPosition;
		light.direction = normalize( lVector );
		float angleCos = dot( light.direction, spotLight.direction );
		float spotAttenuation = getSpotAttenuation( spotLight.coneCos, spotLight.penumbraCos, angleCos );
		if ( spotAttenuation > 0.0 ) {
			float lightDistance = length( lVector );
			light.color = spotLight.color * spotAttenuation;
			light.color *= getDistanceAttenuation( lightDistance, spotLight.distance, spotLight.decay );
			light.visible = ( light.color != vec3( 0.0 ) );
		} else {
			light.color = vec3( 0.0 );
			light.visible = false;
		}
	}
#endif
#if NUM_RECT_AREA_LIGHTS > 0
	struct RectAreaLight {
		vec3 color;
		vec3 position;
		vec3 halfWidth;
		vec3 halfHeight;
	};
	uniform sampler2D ltc_1;	uniform sampler2D ltc_2;
	uniform RectAreaLight rectAreaLights[ NUM_RECT_AREA_LIGHTS ];
#endif
#if NUM_HEMI_LIGHTS > 0
	struct HemisphereLight {
		vec3 direction;
		vec3 skyColor;
		vec3 groundColor;
	};
	uniform HemisphereLight hemisphereLights[ NUM_HEMI_LIGHTS ];
	vec3 getHemisphereLightIrradiance( const in HemisphereLight hemiLight, const in vec3 normal ) {
		float dotNL = dot( normal, hemiLight.direction );
		float hemiDiffuseWeight = 0.5 * dotNL + 0.5;
		vec3 irradiance = mix( hemiLight.groundColor, hemiLight.skyColor, hemiDiffuseWeight );
		return irradiance;
	}
#endif
#include <lightprobes_pars_fragment>`,K0=`#ifdef USE_ENVMAP
	vec3 getIBLIrradiance( const in vec3 normal ) {
		#ifdef ENVMAP_TYPE_PMREM
			vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
			vec4 envMapColor = textureLod( envMap, envMapRotation * worldNormal, ENVMAP_MAX_LOD );
			return PI * envMapColor.rgb * envMapIntensity;
		#else
			return vec3( 0.0 );
		#endif
	}
	vec3 getIBLRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness ) {
		#ifdef ENVMAP_TYPE_PMREM
			vec3 reflectVec = reflect( - viewDir, normal );
			reflectVec = normalize( mix( reflectVec, normal, pow4( roughness ) ) );
			reflectVec = transformDirectionByInverseViewMatrix( reflectVec, viewMatrix );
			vec4 envMapColor = textureLod( envMap, envMapRotation * reflectVec, roughnessToMip( roughness ) );
			return envMapColor.rgb * envMapIntensity;
		#else
			return vec3( 0.0 );
		#endif
	}
	#ifdef USE_RETROREFLECTION
		vec3 getIBLRetroRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness ) {
			#ifdef ENVMAP_TYPE_PMREM
				vec3 retroVec = normalize( mix( viewDir, normal, pow4( roughness ) ) );
				retroVec = transformDirectionByInverseViewMatrix( retroVec, viewMatrix );
				vec4 envMapColor = textureLod( envMap, envMapRotation * retroVec, roughnessToMip( roughness ) );
				return envMapColor.rgb * envMapIntensity;
			#else
				return vec3( 0.0 );
			#endif
		}
	#endif
	#ifdef USE_ANISOTROPY
		vec3 getIBLAnisotropyRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness, const in vec3 bitangent, const in float anisotropy ) {
			#ifdef ENVMAP_TYPE_PMREM
				vec3 bentNormal = cross( bitangent, viewDir );
				bentNormal = normalize( cross( bentNormal, bitangent ) );
				bentNormal = normalize( mix( bentNormal, normal, pow2( pow2( 1.0 - anisotropy * ( 1.0 - roughness ) ) ) ) );
				return getIBLRadiance( viewDir, bentNormal, roughness );
			#else
				return vec3( 0.0 );
			#endif
		}
		#ifdef USE_RETROREFLECTION
			vec3 getIBLAnisotropyRetroRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness, const in vec3 bitangent, const in float anisotropy ) {
				#ifdef ENVMAP_TYPE_PMREM
					vec3 bentNormal = cross( bitangent, viewDir );
					bentNormal = normalize( cross( bentNormal, bitangent ) );
					bentNormal = normalize( mix( bentNormal, normal, pow2( pow2( 1.0 - anisotropy * ( 1.0 - roughness ) ) ) ) );
					return getIBLRetroRadiance( viewDir, bentNormal, roughness );
				#else
					return vec3( 0.0 );
				#endif
			}
		#endif
	#endif
#endif`,Q0=`ToonMaterial material;
material.diffuseColor = diffuseColor.rgb;`,j0=`varying vec3 vViewPosition;
struct ToonMaterial {
	vec3 diffuseColor;
};
void RE_Direct_Toon( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in ToonMaterial material, inout ReflectedLight reflectedLight ) {
	vec3 irradiance = getGradientIrradiance( geometryNormal, directLight.direction ) * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectDiffuse_Toon( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in ToonMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_Toon
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Toon`,tx=`BlinnPhongMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.specularColor = specular;
material.specularShininess = shininess;
material.specularStrength = specularStrength;`,ex=`varying vec3 vViewPosition;
struct BlinnPhongMaterial {
	vec3 diffuseColor;
	vec3 specularColor;
	float specularShininess;
	float specularStrength;
};
void RE_Direct_BlinnPhong( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in BlinnPhongMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
	reflectedLight.directSpecular += irradiance * BRDF_BlinnPhong( directLight.direction, geometryViewDir, geometryNormal, material.specularColor, material.specularShininess ) * material.specularStrength;
}
void RE_IndirectDiffuse_BlinnPhong( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in BlinnPhongMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_BlinnPhong
#define RE_IndirectDiffuse		RE_IndirectDiffuse_BlinnPhong`,nx=`PhysicalMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.diffuseContribution = diffuseColor.rgb * ( 1.0 - metalnessFactor );
material.metalness = metalnessFactor;
vec3 dxy = max( abs( dFdx( nonPerturbedNormal ) ), abs( dFdy( nonPerturbedNormal ) ) );
float geometryRoughness = max( max( dxy.x, dxy.y ), dxy.z );
material.roughness = max( roughnessFactor, 0.045 );
material.roughness += geometryRoughness;
material.roughness = min( material.roughness, 1.0 );
#ifdef USE_DIFFUSE_ROUGHNESS
	float diffuseRoughnessFactor = diffuseRoughness;
	#ifdef USE_DIFFUSE_ROUGHNESSMAP
		diffuseRoughnessFactor *= texture2D( diffuseRoughnessMap, vDiffuseRoughnessMapUv ).r;
	#endif
	material.diffuseRoughness = saturate( diffuseRoughnessFactor );
#endif
#ifdef IOR
	material.ior = ior;
	#ifdef USE_SPECULAR
		float specularIntensityFactor = specularIntensity;
		vec3 specularColorFactor = specularColor;
		#ifdef USE_SPECULAR_COLORMAP
			specularColorFactor *= texture2D( specularColorMap, vSpecularColorMapUv ).rgb;
		#endif
		#ifdef USE_SPECULAR_INTENSITYMAP
			specularIntensityFactor *= texture2D( specularIntensityMap, vSpecularIntensityMapUv ).a;
		#endif
		material.specularF90 = mix( specularIntensityFactor, 1.0, metalnessFactor );
	#else
		float specularIntensityFactor = 1.0;
		vec3 specularColorFactor = vec3( 1.0 );
		material.specularF90 = 1.0;
	#endif
	material.specularColor = min( pow2( ( material.ior - 1.0 ) / ( material.ior + 1.0 ) ) * specularColorFactor, vec3( 1.0 ) ) * specularIntensityFactor;
	material.specularColorBlended = mix( material.specularColor, diffuseColor.rgb, metalnessFactor );
#else
	material.specularColor = vec3( 0.04 );
	material.specularColorBlended = mix( material.specularColor, diffuseColor.rgb, metalnessFactor );
	material.specularF90 = 1.0;
#endif
#ifdef USE_CLEARCOAT
	material.clearcoat = clearcoat;
	material.clearcoatRoughness = clearcoatRoughness;
	material.clearcoatF0 = vec3( 0.04 );
	material.clearcoatF90 = 1.0;
	#ifdef USE_CLEARCOATMAP
		material.clearcoat *= texture2D( clearcoatMap, vClearcoatMapUv ).x;
	#endif
	#ifdef USE_CLEARCOAT_ROUGHNESSMAP
		material.clearcoatRoughness *= texture2D( clearcoatRoughnessMap, vClearcoatRoughnessMapUv ).y;
	#endif
	material.clearcoat = saturate( material.clearcoat );	material.clearcoatRoughness = max( material.clearcoatRoughness, 0.045 );
	material.clearcoatRoughness += geometryRoughness;
	material.clearcoatRoughness = min( material.clearcoatRoughness, 1.0 );
#endif
#ifdef USE_DISPERSION
	material.dispersion = dispersion;
#endif
#ifdef USE_RETROREFLECTION
	material.retroreflectivity = retroreflectivity;
#endif
#ifdef USE_IRIDESCENCE
	material.iridescence = iridescence;
	material.iridescenceIOR = iridescenceIOR;
	#ifdef USE_IRIDESCENCEMAP
		material.iridescence *= texture2D( iridescenceMap, vIridescenceMapUv ).r;
	#endif
	#ifdef USE_IRIDESCENCE_THICKNESSMAP
		material.iridescenceThickness = (iridescenceThicknessMaximum - iridescenceThicknessMinimum) * texture2D( iridescenceThicknessMap, vIridescenceThicknessMapUv ).g + iridescenceThicknessMinimum;
	#else
		material.iridescenceThickness = iridescenceThicknessMaximum;
	#endif
#endif
#ifdef USE_SHEEN
	material.sheenColor = sheenColor;
	#ifdef USE_SHEEN_COLORMAP
		material.sheenColor *= texture2D( sheenColorMap, vSheenColorMapUv ).rgb;
	#endif
	material.sheenRoughness = clamp( sheenRoughness, 0.0001, 1.0 );
	#ifdef USE_SHEEN_ROUGHNESSMAP
		material.sheenRoughness *= texture2D( sheenRoughnessMap, vSheenRoughnessMapUv ).a;
	#endif
#endif
#ifdef USE_ANISOTROPY
	#ifdef USE_ANISOTROPYMAP
		mat2 anisotropyMat = mat2( anisotropyVector.x, anisotropyVector.y, - anisotropyVector.y, anisotropyVector.x );
		vec3 anisotropyPolar = texture2D( anisotropyMap, vAnisotropyMapUv ).rgb;
		vec2 anisotropyV = anisotropyMat * normalize( 2.0 * anisotropyPolar.rg - vec2( 1.0 ) ) * anisotropyPolar.b;
	#else
		vec2 anisotropyV = anisotropyVector;
	#endif
	material.anisotropy = length( anisotropyV );
	if( material.anisotropy == 0.0 ) {
		anisotropyV = vec2( 1.0, 0.0 );
	} else {
		anisotropyV /= material.anisotropy;
		material.anisotropy = saturate( material.anisotropy );
	}
	material.alphaT = mix( pow2( material.roughness ), 1.0, pow2( material.anisotropy ) );
	material.anisotropyT = tbn[ 0 ] * anisotropyV.x + tbn[ 1 ] * anisotropyV.y;
	material.anisotropyB = tbn[ 1 ] * anisotropyV.x - tbn[ 0 ] * anisotropyV.y;
#endif`,ix=`uniform sampler2D dfgLUT;
struct PhysicalMaterial {
	vec3 diffuseColor;
	vec3 diffuseContribution;
	vec3 specularColor;
	vec3 specularColorBlended;
	float roughness;
	float metalness;
	float specularF90;
	float dispersion;
	vec2 dfg;
	vec3 multiScatteringCompensation;
	#ifdef USE_DIFFUSE_ROUGHNESS
		float diffuseRoughness;
	#endif
	#ifdef USE_RETROREFLECTION
		float retroreflectivity;
	#endif
	#ifdef USE_CLEARCOAT
		float clearcoat;
		float clearcoatRoughness;
		vec3 clearcoatF0;
		float clearcoatF90;
	#endif
	#ifdef USE_IRIDESCENCE
		float iridescence;
		float iridescenceIOR;
		float iridescenceThickness;
		vec3 iridescenceFresnel;
		vec3 iridescenceF0Dielectric;
		vec3 iridescenceF0Metallic;
	#endif
	#ifdef USE_SHEEN
		vec3 sheenColor;
		float sheenRoughness;
	#endif
	#ifdef IOR
		float ior;
	#endif
	#ifdef USE_TRANSMISSION
		float transmission;
		float transmissionAlpha;
		float thickness;
		float attenuationDistance;
		vec3 attenuationColor;
	#endif
	#ifdef USE_ANISOTROPY
		float anisotropy;
		float alphaT;
		vec3 anisotropyT;
		vec3 anisotropyB;
	#endif
};
vec3 clearcoatSpecularDirect = vec3( 0.0 );
vec3 clearcoatSpecularIndirect = vec3( 0.0 );
vec3 sheenSpecularDirect = vec3( 0.0 );
vec3 sheenSpecularIndirect = vec3(0.0 );
vec3 Schlick_to_F0( const in vec3 f, const in float f90, const in float dotVH ) {
    float x = clamp( 1.0 - dotVH, 0.0, 1.0 );
    float x2 = x * x;
    float x5 = clamp( x * x2 * x2, 0.0, 0.9999 );
    return ( f - vec3( f90 ) * x5 ) / ( 1.0 - x5 );
}
#ifdef USE_DIFFUSE_ROUGHNESS
	const float EON_EPSILON = 1e-7;
	float FON_DirectionalAlbedo( const in float mu, const in float roughness, const in float A ) {
		float muComp = 1.0 - mu;
		float gOverPi = muComp * ( 0.0571085289 + muComp * ( 0.491881867 + muComp * ( - 0.332181442 + muComp * 0.0714429953 ) ) );
		return A * ( 1.0 + roughness * gOverPi );
	}
	vec3 BRDF_EON( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in vec3 diffuseColor, const in float roughness ) {
		vec3 rho = saturate( diffuseColor );
		if ( roughness <= EON_EPSILON ) return BRDF_Lambert( rho );
		float dotNL = saturate( dot( normal, lightDir ) );
		float dotNV = saturate( dot( normal, viewDir ) );
		float s = dot( lightDir, viewDir ) - dotNL * dotNV;
		float sOverT = ( s > 0.0 ) ? s / max( max( dotNL, dotNV ), EON_EPSILON ) : s;
		float A = 1.0 / ( 1.0 + ( 0.5 - 2.0 / ( 3.0 * PI ) ) * roughness );
		vec3 singleScatter = rho * RECIPROCAL_PI * A * ( 1.0 + roughness * sOverT );
		float averageAlbedo = A * ( 1.0 + ( 2.0 / 3.0 - 28.0 / ( 15.0 * PI ) ) * roughness );
		float albedoV = FON_DirectionalAlbedo( dotNV, roughness, A );
		float albedoL = FON_DirectionalAlbedo( dotNL, roughness, A );
		vec3 rhoMultiScatter = rho * rho * averageAlbedo / max( vec3( EON_EPSILON ), vec3( 1.0 ) - rho * ( 1.0 - averageAlbedo ) );
		vec3 multiScatter = rhoMultiScatter * RECIPROCAL_PI
			* max( EON_EPSILON, 1.0 - albedoV )
			* max( EON_EPSILON, 1.0 - albedoL )
			/ max( EON_EPSILON, 1.0 - averageAlbedo );
		return singleScatter + multiScatter;
	}
	vec3 EON_DirectionalAlbedo( const in vec3 diffuseColor, const in float roughness, const in float dotNV ) {
		vec3 rho = saturate( diffuseColor );
		if ( roughness <= EON_EPSILON ) return rho;
		float A = 1.0 / ( 1.0 + ( 0.5 - 2.0 / ( 3.0 * PI ) ) * roughness );
		float directionalAlbedo = FON_DirectionalAlbedo( dotNV, roughness, A );
		float averageAlbedo = A * ( 1.0 + ( 2.0 / 3.0 - 28.0 / ( 15.0 * PI ) ) * roughness );
		vec3 rhoMultiScatter = rho * rho * averageAlbedo / max( vec3( EON_EPSILON ), vec3( 1.0 ) - rho * ( 1.0 - averageAlbedo ) );
		return rho * directionalAlbedo + rhoMultiScatter * ( 1.0 - directionalAlbedo );
	}
#endif
float V_GGX_SmithCorrelated( const in float alpha, const in float dotNL, const in float dotNV ) {
	float a2 = pow2( alpha );
	float gv = dotNL * sqrt( a2 + ( 1.0 - a2 ) * pow2( dotNV ) );
	float gl = dotNV * sqrt( a2 + ( 1.0 - a2 ) * pow2( dotNL ) );
	return 0.5 / max( gv + gl, EPSILON );
}
float D_GGX( const in float alpha, const in float dotNH ) {
	float a2 = pow2( alpha );
	float denom = pow2( dotNH ) * ( a2 - 1.0 ) + 1.0;
	return RECIPROCAL_PI * a2 / pow2( denom );
}
#ifdef USE_ANISOTROPY
	float V_GGX_SmithCorrelated_Anisotropic( const in float alphaT, const in float alphaB, const in float dotTV, const in float dotBV, const in float dotTL, const in float dotBL, const in float dotNV, const in float dotNL ) {
		float gv = dotNL * length( vec3( alphaT * dotTV, alphaB * dotBV, dotNV ) );
		float gl = dotNV * length( vec3( alphaT * dotTL, alphaB * dotBL, dotNL ) );
		return 0.5 / max( gv + gl, EPSILON );
	}
	float D_GGX_Anisotropic( const in float alphaT, const in float alphaB, const in float dotNH, const in float dotTH, const in float dotBH ) {
		float a2 = alphaT * alphaB;
		highp vec3 v = vec3( alphaB * dotTH, alphaT * dotBH, a2 * dotNH );
		highp float v2 = dot( v, v );
		float w2 = a2 / v2;
		return RECIPROCAL_PI * a2 * pow2 ( w2 );
	}
#endif
#ifdef USE_CLEARCOAT
	vec3 BRDF_GGX_Clearcoat( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in PhysicalMaterial material) {
		vec3 f0 = material.clearcoatF0;
		float f90 = material.clearcoatF90;
		float roughness = max( material.clearcoatRoughness, 0.045 );
		float alpha = pow2( roughness );
		vec3 halfDir = normalize( lightDir + viewDir );
		float dotNL = saturate( dot( normal, lightDir ) );
		float dotNV = saturate( dot( normal, viewDir ) );
		float dotNH = saturate( dot( normal, halfDir ) );
		float dotVH = saturate( dot( viewDir, halfDir ) );
		vec3 F = F_Schlick( f0, f90, dotVH );
		float V = V_GGX_SmithCorrelated( alpha, dotNL, dotNV );
		float D = D_GGX( alpha, dotNH );
		return F * ( V * D );
	}
#endif
vec3 BRDF_GGX( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in PhysicalMaterial material ) {
	vec3 f0 = material.specularColorBlended;
	float f90 = material.specularF90;
	float roughness = max( material.roughness, 0.045 );
	float alpha = pow2( roughness );
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNL = saturate( dot( normal, lightDir ) );
	float dotNV = saturate( dot( normal, viewDir ) );
	float dotNH = saturate( dot( normal, halfDir ) );
	float dotVH = saturate( dot( viewDir, halfDir ) );
	vec3 F = F_Schlick( f0, f90, dotVH );
	#ifdef USE_IRIDESCENCE
		F = mix( F, material.iridescenceFresnel, material.iridescence );
	#endif
	#ifdef USE_ANISOTROPY
		float dotTL = dot( material.anisotropyT, lightDir );
		float dotTV = dot( material.anisotropyT, viewDir );
		float dotTH = dot( material.anisotropyT, halfDir );
		float dotBL = dot( material.anisotropyB, lightDir );
		float dotBV = dot( material.anisotropyB, viewDir );
		float dotBH = dot( material.anisotropyB, halfDir );
		float alphaT = max( material.alphaT, alpha );
		float V = V_GGX_SmithCorrelated_Anisotropic( alphaT, alpha, dotTV, dotBV, dotTL, dotBL, dotNV, dotNL );
		float D = D_GGX_Anisotropic( alphaT, alpha, dotNH, dotTH, dotBH );
	#else
		float V = V_GGX_SmithCorrelated( alpha, dotNL, dotNV );
		float D = D_GGX( alpha, dotNH );
	#endif
	return F * ( V * D );
}
vec2 LTC_Uv( const in vec3 N, const in vec3 V, const in float roughness ) {
	const float LUT_SIZE = 64.0;
	const float LUT_SCALE = ( LUT_SIZE - 1.0 ) / LUT_SIZE;
	const float LUT_BIAS = 0.5 / LUT_SIZE;
	float dotNV = saturate( dot( N, V ) );
	vec2 uv = vec2( roughness, sqrt( 1.0 - dotNV ) );
	uv = uv * LUT_SCALE + LUT_BIAS;
	return uv;
}
float LTC_ClippedSphereFormFactor( const in vec3 f ) {
	float l = length( f );
	return max( ( l * l + f.z ) / ( l + 1.0 ), 0.0 );
}
vec3 LTC_EdgeVectorFormFactor( const in vec3 v1, const in vec3 v2 ) {
	float x = dot( v1, v2 );
	float y = abs( x );
	float a = 0.8543985 + ( 0.4965155 + 0.0145206 * y ) * y;
	float b = 3.4175940 + ( 4.1616724 + y ) * y;
	float v = a / b;
	float theta_sintheta = ( x > 0.0 ) ? v : 0.5 * inversesqrt( max( 1.0 - x * x, 1e-7 ) ) - v;
	return cross( v1, v2 ) * theta_sintheta;
}
vec3 LTC_Evaluate( const in vec3 N, const in vec3 V, const in vec3 P, const in mat3 mInv, const in vec3 rectCoords[ 4 ] ) {
	vec3 v1 = rectCoords[ 1 ] - rectCoords[ 0 ];
	vec3 v2 = rectCoords[ 3 ] - rectCoords[ 0 ];
	vec3 lightNormal = cross( v1, v2 );
	if( dot( lightNormal, P - rectCoords[ 0 ] ) < 0.0 ) return vec3( 0.0 );
	vec3 T1, T2;
	T1 = normalize( V - N * dot( V, N ) );
	T2 = - cross( N, T1 );
	mat3 mat = mInv * transpose( mat3( T1, T2, N ) );
	vec3 coords[ 4 ];
	coords[ 0 ] = mat * ( rectCoords[ 0 ] - P );
	coords[ 1 ] = mat * ( rectCoords[ 1 ] - P );
	coords[ 2 ] = mat * ( rectCoords[ 2 ] - P );
	coords[ 3 ] = mat * ( rectCoords[ 3 ] - P );
	coords[ 0 ] = normalize( coords[ 0 ] );
	coords[ 1 ] = normalize( coords[ 1 ] );
	coords[ 2 ] = normalize( coords[ 2 ] );
	coords[ 3 ] = normalize( coords[ 3 ] );
	vec3 vectorFormFactor = vec3( 0.0 );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 0 ], coords[ 1 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 1 ], coords[ 2 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 2 ], coords[ 3 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 3 ], coords[ 0 ] );
	float result = LTC_ClippedSphereFormFactor( vectorFormFactor );
	return vec3( result );
}
#if defined( USE_SHEEN )
float D_Charlie( float roughness, float dotNH ) {
	float alpha = pow2( roughness );
	float invAlpha = 1.0 / alpha;
	float cos2h = dotNH * dotNH;
	float sin2h = max( 1.0 - cos2h, 0.0078125 );
	return ( 2.0 + invAlpha ) * pow( sin2h, invAlpha * 0.5 ) / ( 2.0 * PI );
}
float V_Neubelt( float dotNV, float dotNL ) {
	return saturate( 1.0 / ( 4.0 * ( dotNL + dotNV - dotNL * dotNV ) ) );
}
vec3 BRDF_Sheen( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, vec3 sheenColor, const in float sheenRoughness ) {
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNL = saturate( dot( normal, lightDir ) );
	float dotNV = saturate( dot( normal, viewDir ) );
	float dotNH = saturate( dot( normal, halfDir ) );
	float D = D_Charlie( sheenRoughness, dotNH );
	float V = V_Neubelt( dotNV, dotNL );
	return sheenColor * ( D * V );
}
#endif
float IBLSheenBRDF( const in vec3 normal, const in vec3 viewDir, const in float roughness ) {
	float dotNV = saturate( dot( normal, viewDir ) );
	float r2 = roughness * roughness;
	float rInv = 1.0 / ( roughness + 0.1 );
	float a = -1.9362 + 1.0678 * roughness + 0.4573 * r2 - 0.8469 * rInv;
	float b = -0.6014 + 0.5538 * roughness - 0.4670 * r2 - 0.1255 * rInv;
	float DG = exp( a * dotNV + b );
	return saturate( DG );
}
vec3 EnvironmentBRDF( const in vec3 normal, const in vec3 viewDir, const in vec3 specularColor, const in float specularF90, const in float roughness ) {
	float dotNV = saturate( dot( normal, viewDir ) );
	vec2 fab = texture2D( dfgLUT, vec2( roughness, dotNV ) ).rg;
	return specularColor * fab.x + specularF90 * fab.y;
}
#ifdef USE_IRIDESCENCE
void computeMultiscatteringIridescence( const in vec2 fab, const in vec3 specularColor, const in float specularF90, const in float iridescence, const in vec3 iridescenceF0, inout vec3 singleScatter, inout vec3 multiScatter ) {
#else
void computeMultiscattering( const in vec2 fab, const in vec3 specularColor, const in float specularF90, inout vec3 singleScatter, inout vec3 multiScatter ) {
#endif
	#ifdef USE_IRIDESCENCE
		vec3 Fr = mix( specularColor, iridescenceF0, iridescence );
	#else
		vec3 Fr = specularColor;
	#endif
	vec3 FssEss = Fr * fab.x + specularF90 * fab.y;
	float Ess = fab.x + fab.y;
	float Ems = 1.0 - Ess;
	vec3 Favg = Fr + ( 1.0 - Fr ) * 0.047619;	vec3 Fms = FssEss * Favg / ( 1.0 - Ems * Favg );
	singleScatter += FssEss;
	multiScatter += Fms * Ems;
}
#if NUM_RECT_AREA_LIGHTS > 0
	void RE_Direct_RectArea_Physical( const in RectAreaLight rectAreaLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
		vec3 normal = geometryNormal;
		vec3 viewDir = geometryViewDir;
		vec3 position = geometryPosition;
		vec3 lightPos = rectAreaLight.position;
		vec3 halfWidth = rectAreaLight.halfWidth;
		vec3 halfHeight = rectAreaLight.halfHeight;
		vec3 lightColor = rectAreaLight.color;
		float roughness = material.roughness;
		vec3 rectCoords[ 4 ];
		rectCoords[ 0 ] = lightPos + halfWidth - halfHeight;		rectCoords[ 1 ] = lightPos - halfWidth - halfHeight;
		rectCoords[ 2 ] = lightPos - halfWidth + halfHeight;
		rectCoords[ 3 ] = lightPos + halfWidth + halfHeight;
		vec2 uv = LTC_Uv( normal, viewDir, roughness );
		vec4 t1 = texture2D( ltc_1, uv );
		vec4 t2 = texture2D( ltc_2, uv );
		mat3 mInv = mat3(
			vec3( t1.x, 0, t1.y ),
			vec3(    0, 1,    0 ),
			vec3( t1.z, 0, t1.w )
		);
		vec3 fresnel = ( material.specularColorBlended * t2.x + ( material.specularF90 - material.specularColorBlended ) * t2.y );
		reflectedLight.directSpecular += lightColor * fresnel * LTC_Evaluate( normal, viewDir, position, mInv, rectCoords );
		reflectedLight.directDiffuse += lightColor * material.diffuseContribution * LTC_Evaluate( normal, viewDir, position, mat3( 1.0 ), rectCoords );
		#ifdef USE_CLEARCOAT
			vec3 Ncc = geometryClearcoatNormal;
			vec2 uvClearcoat = LTC_Uv( Ncc, viewDir, material.clearcoatRoughness );
			vec4 t1Clearcoat = texture2D( ltc_1, uvClearcoat );
			vec4 t2Clearcoat = texture2D( ltc_2, uvClearcoat );
			mat3 mInvClearcoat = mat3(
				vec3( t1Clearcoat.x, 0, t1Clearcoat.y ),
				vec3(             0, 1,             0 ),
				vec3( t1Clearcoat.z, 0, t1Clearcoat.w )
			);
			vec3 fresnelClearcoat = material.clearcoatF0 * t2Clearcoat.x + ( material.clearcoatF90 - material.clearcoatF0 ) * t2Clearcoat.y;
			clearcoatSpecularDirect += lightColor * fresnelClearcoat * LTC_Evaluate( Ncc, viewDir, position, mInvClearcoat, rectCoords );
		#endif
	}
#endif
void RE_Direct_Physical( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	#ifdef USE_CLEARCOAT
		float dotNLcc = saturate( dot( geometryClearcoatNormal, directLight.direction ) );
		vec3 ccIrradiance = dotNLcc * directLight.color;
		clearcoatSpecularDirect += ccIrradiance * BRDF_GGX_Clearcoat( directLight.direction, geometryViewDir, geometryClearcoatNormal, material );
	#endif
	#ifdef USE_SHEEN
 
 		sheenSpecularDirect += irradiance * BRDF_Sheen( directLight.direction, geometryViewDir, geometryNormal, material.sheenColor, material.sheenRoughness );
 
 		float sheenAlbedoV = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
 		float sheenAlbedoL = IBLSheenBRDF( geometryNormal, directLight.direction, material.sheenRoughness );
 
 		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * max( sheenAlbedoV, sheenAlbedoL );
 
 		irradiance *= sheenEnergyComp;
 
 	#endif
	vec3 specularBRDF = BRDF_GGX( directLight.direction, geometryViewDir, geometryNormal, material );
	#ifdef USE_RETROREFLECTION
		vec3 retroViewDir = reflect( - geometryViewDir, geometryNormal );
		vec3 retroSpecularBRDF = BRDF_GGX( directLight.direction, retroViewDir, geometryNormal, material );
		specularBRDF = mix( specularBRDF, retroSpecularBRDF, saturate( material.retroreflectivity ) );
	#endif
	reflectedLight.directSpecular += irradiance * specularBRDF * material.multiScatteringCompensation;
	vec3 halfDir = normalize( directLight.direction + geometryViewDir );
	float dotVH = saturate( dot( geometryViewDir, halfDir ) );
	vec3 F = F_Schlick( material.specularColor, material.specularF90, dotVH );
	#ifdef USE_RETROREFLECTION
		vec3 retroHalfDir = normalize( directLight.direction + retroViewDir );
		float dotRetroVH = saturate( dot( retroViewDir, retroHalfDir ) );
		vec3 retroF = F_Schlick( material.specularColor, material.specularF90, dotRetroVH );
		F = mix( F, retroF, saturate( material.retroreflectivity ) );
	#endif
	#ifdef USE_DIFFUSE_ROUGHNESS
		vec3 diffuseBRDF = BRDF_EON( directLight.direction, geometryViewDir, geometryNormal, material.diffuseColor, material.diffuseRoughness ) * ( 1.0 - material.metalness );
	#else
		vec3 diffuseBRDF = BRDF_Lambert( material.diffuseContribution );
	#endif
	reflectedLight.directDiffuse += irradiance * diffuseBRDF * ( 1.0 - F );
}
void RE_IndirectDiffuse_Physical( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
	vec3 singleScattering = vec3( 0.0 );
	vec3 multiScattering = vec3( 0.0 );
	#ifdef USE_IRIDESCENCE
		computeMultiscatteringIridescence( material.dfg, material.specularColor, material.specularF90, material.iridescence, material.iridescenceF0Dielectric, singleScattering, multiScattering );
	#else
		computeMultiscattering( material.dfg, material.specularColor, material.specularF90, singleScattering, multiScattering );
	#endif
	#ifdef USE_DIFFUSE_ROUGHNESS
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		vec3 diffuseAlbedo = EON_DirectionalAlbedo( material.diffuseColor, material.diffuseRoughness, dotNV ) * ( 1.0 - material.metalness );
		vec3 diffuse = irradiance * RECIPROCAL_PI * diffuseAlbedo * ( 1.0 - singleScattering - multiScattering );
	#else
		vec3 diffuse = irradiance * BRDF_Lambert( material.diffuseContribution ) * ( 1.0 - singleScattering - multiScattering );
	#endif
	#ifdef USE_SHEEN
		float sheenAlbedo = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
		sheenSpecularIndirect += irradiance * material.sheenColor * sheenAlbedo * RECIPROCAL_PI;
		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * sheenAlbedo;
		diffuse *= sheenEnergyComp;
	#endif
	reflectedLight.indirectDiffuse += diffuse;
}
void RE_IndirectSpecular_Physical( const in vec3 radiance, const in vec3 irradiance, const in vec3 clearcoatRadiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight) {
	#ifdef USE_CLEARCOAT
		clearcoatSpecularIndirect += clearcoatRadiance * EnvironmentBRDF( geometryClearcoatNormal, geometryViewDir, material.clearcoatF0, material.clearcoatF90, material.clearcoatRoughness );
	#endif
	#ifdef USE_SHEEN
		sheenSpecularIndirect += irradiance * material.sheenColor * IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness ) * RECIPROCAL_PI;
 	#endif
	vec3 singleScatteringDielectric = vec3( 0.0 );
	vec3 multiScatteringDielectric = vec3( 0.0 );
	vec3 singleScatteringMetallic = vec3( 0.0 );
	vec3 multiScatteringMetallic = vec3( 0.0 );
	#ifdef USE_IRIDESCENCE
		computeMultiscatteringIridescence( material.dfg, material.specularColor, material.specularF90, material.iridescence, material.iridescenceF0Dielectric, singleScatteringDielectric, multiScatteringDielectric );
		computeMultiscatteringIridescence( material.dfg, material.diffuseColor, material.specularF90, material.iridescence, material.iridescenceF0Metallic, singleScatteringMetallic, multiScatteringMetallic );
	#else
		computeMultiscattering( material.dfg, material.specularColor, material.specularF90, singleScatteringDielectric, multiScatteringDielectric );
		computeMultiscattering( material.dfg, material.diffuseColor, material.specularF90, singleScatteringMetallic, multiScatteringMetallic );
	#endif
	vec3 singleScattering = mix( singleScatteringDielectric, singleScatteringMetallic, material.metalness );
	vec3 multiScattering = mix( multiScatteringDielectric, multiScatteringMetallic, material.metalness );
	vec3 totalScatteringDielectric = singleScatteringDielectric + multiScatteringDielectric;
	#ifdef USE_DIFFUSE_ROUGHNESS
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		vec3 diffuse = EON_DirectionalAlbedo( material.diffuseColor, material.diffuseRoughness, dotNV ) * ( 1.0 - material.metalness ) * ( 1.0 - totalScatteringDielectric );
	#else
		vec3 diffuse = material.diffuseContribution * ( 1.0 - totalScatteringDielectric );
	#endif
	vec3 cosineWeightedIrradiance = irradiance * RECIPROCAL_PI;
	vec3 indirectSpecular = radiance * singleScattering;
	indirectSpecular += multiScattering * cosineWeightedIrradiance;
	vec3 indirectDiffuse = diffuse * cosineWeightedIrradiance;
	#ifdef USE_SHEEN
		float sheenAlbedo = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * sheenAlbedo;
		indirectSpecular *= sheenEnergyComp;
		indirectDiffuse *= sheenEnergyComp;
	#endif
	reflectedLight.indirectSpecular += indirectSpecular;
	reflectedLight.indirectDiffuse += indirectDiffuse;
}
#define RE_Direct				RE_Direct_Physical
#define RE_Direct_RectArea		RE_Direct_RectArea_Physical
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Physical
#define RE_IndirectSpecular		RE_IndirectSpecular_Physical
float computeSpecularOcclusion( const in float dotNV, const in float ambientOcclusion, const in float roughness ) {
	return saturate( pow( dotNV + ambientOcclusion, exp2( - 16.0 * roughness - 1.0 ) ) - 1.0 + ambientOcclusion );
}`,sx=`
vec3 geometryPosition = - vViewPosition;
vec3 geometryNormal = normal;
vec3 geometryViewDir = ( isOrthographic ) ? vec3( 0, 0, 1 ) : normalize( vViewPosition );
vec3 geometryClearcoatNormal = vec3( 0.0 );
#ifdef USE_CLEARCOAT
	geometryClearcoatNormal = clearcoatNormal;
#endif
#ifdef USE_IRIDESCENCE
	float dotNVi = saturate( dot( normal, geometryViewDir ) );
	if ( material.iridescenceThickness == 0.0 ) {
		material.iridescence = 0.0;
	} else {
		material.iridescence = saturate( material.iridescence );
	}
	if ( material.iridescence > 0.0 ) {
		vec3 iridescenceFresnelDielectric = evalIridescence( 1.0, material.iridescenceIOR, dotNVi, material.iridescenceThickness, material.specularColor );
		vec3 iridescenceFresnelMetallic = evalIridescence( 1.0, material.iridescenceIOR, dotNVi, material.iridescenceThickness, material.diffuseColor );
		material.iridescenceFresnel = mix( iridescenceFresnelDielectric, iridescenceFresnelMetallic, material.metalness );
		material.iridescenceF0Dielectric = Schlick_to_F0( iridescenceFresnelDielectric, 1.0, dotNVi );
		material.iridescenceF0Metallic = Schlick_to_F0( iridescenceFresnelMetallic, 1.0, dotNVi );
	}
#endif
#ifdef STANDARD
	float dotNVms = saturate( dot( geometryNormal, geometryViewDir ) );
	material.dfg = texture2D( dfgLUT, vec2( material.roughness, dotNVms ) ).rg;
	#if ( NUM_SUN_LIGHTS > 0 || NUM_DIR_LIGHTS > 0 || NUM_POINT_LIGHTS > 0 || NUM_SPOT_LIGHTS > 0 )
		float EssMs = material.dfg.x + material.dfg.y;
		material.multiScatteringCompensation = 1.0 + material.specularColorBlended * ( 1.0 / EssMs - 1.0 );
	#endif
#endif
IncidentLight directLight;
#if ( NUM_POINT_LIGHTS > 0 ) && defined( RE_Direct )
	PointLight pointLight;
	#if defined( USE_SHADOWMAP ) && NUM_POINT_LIGHT_SHADOWS > 0
	PointLightShadow pointLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_POINT_LIGHTS; i ++ ) {
		pointLight = pointLights[ i ];
		getPointLightInfo( pointLight, geometryPosition, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_POINT_LIGHT_SHADOWS ) && ( defined( SHADOWMAP_TYPE_PCF ) || defined( SHADOWMAP_TYPE_BASIC ) )
		pointLightShadow = pointLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getPointShadow( pointShadowMap[ i ], pointLightShadow.shadowMapSize, pointLightShadow.shadowIntensity, pointLightShadow.shadowBias, pointLightShadow.shadowRadius, vPointShadowCoord[ i ], pointLightShadow.shadowCameraNear, pointLightShadow.shadowCameraFar ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_SPOT_LIGHTS > 0 ) && defined( RE_Direct )
	SpotLight spotLight;
	vec4 spotColor;
	vec3 spotLightCoord;
	bool inSpotLightMap;
	#if defined( USE_SHADOWMAP ) && NUM_SPOT_LIGHT_SHADOWS > 0
	SpotLightShadow spotLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHTS; i ++ ) {
		spotLight = spotLights[ i ];
		getSpotLightInfo( spotLight, geometryPosition, directLight );
		#if ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS )
		#define SPOT_LIGHT_MAP_INDEX UNROLLED_LOOP_INDEX
		#elif ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
		#define SPOT_LIGHT_MAP_INDEX NUM_SPOT_LIGHT_MAPS
		#else
		#define SPOT_LIGHT_MAP_INDEX ( UNROLLED_LOOP_INDEX - NUM_SPOT_LIGHT_SHADOWS + NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS )
		#endif
		#if ( SPOT_LIGHT_MAP_INDEX < NUM_SPOT_LIGHT_MAPS )
			spotLightCoord = vSpotLightCoord[ i ].xyz / vSpotLightCoord[ i ].w;
			inSpotLightMap = all( lessThan( abs( spotLightCoord * 2. - 1. ), vec3( 1.0 ) ) );
			spotColor = texture2D( spotLightMap[ SPOT_LIGHT_MAP_INDEX ], spotLightCoord.xy );
			directLight.color = inSpotLightMap ? directLight.color * spotColor.rgb : directLight.color;
		#endif
		#undef SPOT_LIGHT_MAP_INDEX
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
		spotLightShadow = spotLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getShadow( spotShadowMap[ i ], spotLightShadow.shadowMapSize, spotLightShadow.shadowIntensity, spotLightShadow.shadowBias, spotLightShadow.shadowRadius, vSpotLightCoord[ i ] ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_SUN_LIGHTS > 0 ) && defined( RE_Direct )
	SunLight sunLight;
	#if defined( USE_SHADOWMAP ) && NUM_SUN_LIGHT_SHADOWS > 0
	SunLightShadow sunLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SUN_LIGHTS; i ++ ) {
		sunLight = sunLights[ i ];
		getSunLightInfo( sunLight, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_SUN_LIGHT_SHADOWS )
		sunLightShadow = sunLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getSunShadow( sunShadowMap[ i ], sunLightShadow, UNROLLED_LOOP_INDEX ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_DIR_LIGHTS > 0 ) && defined( RE_Direct )
	DirectionalLight directionalLight;
	#if defined( USE_SHADOWMAP ) && NUM_DIR_LIGHT_SHADOWS > 0
	DirectionalLightShadow directionalLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_DIR_LIGHTS; i ++ ) {
		directionalLight = directionalLights[ i ];
		getDirectionalLightInfo( directionalLight, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_DIR_LIGHT_SHADOWS )
		directionalLightShadow = directionalLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getShadow( directionalShadowMap[ i ], directionalLightShadow.shadowMapSize, directionalLightShadow.shadowIntensity, directionalLightShadow.shadowBias, directionalLightShadow.shadowRadius, vDirectionalShadowCoord[ i ] ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_RECT_AREA_LIGHTS > 0 ) && defined( RE_Direct_RectArea )
	RectAreaLight rectAreaLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_RECT_AREA_LIGHTS; i ++ ) {
		rectAreaLight = rectAreaLights[ i ];
		RE_Direct_RectArea( rectAreaLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if defined( RE_IndirectDiffuse )
	vec3 iblIrradiance = vec3( 0.0 );
	vec3 irradiance = getAmbientLightIrradiance( ambientLightColor );
	#if defined( USE_LIGHT_PROBES )
		irradiance += getLightProbeIrradiance( lightProbe, geometryNormal );
	#endif
	#if ( NUM_HEMI_LIGHTS > 0 )
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_HEMI_LIGHTS; i ++ ) {
			irradiance += getHemisphereLightIrradiance( hemisphereLights[ i ], geometryNormal );
		}
		#pragma unroll_loop_end
	#endif
	#if NUM_LIGHT_PROBE_GRIDS > 0
		vec3 probeWorldPos = ( ( vec4( geometryPosition, 1.0 ) - viewMatrix[ 3 ] ) * viewMatrix ).xyz;
		vec3 probeWorldNormal = transformNormalByInverseViewMatrix( geometryNormal, viewMatrix );
		int probeGrid = - 1;
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_LIGHT_PROBE_GRIDS; i ++ ) {
			if ( isInsideLightProbeGrid( probeWorldPos, probeWorldNormal, probesMin[ i ], probesMax[ i ], probesResolution[ i ] ) ) probeGrid = UNROLLED_LOOP_INDEX;
		}
		#pragma unroll_loop_end
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_LIGHT_PROBE_GRIDS; i ++ ) {
			if ( probeGrid == UNROLLED_LOOP_INDEX ) irradiance += getLightProbeGridIrradiance( probesSH[ i ], probesMin[ i ], probesMax[ i ], probesResolution[ i ], probeWorldPos, probeWorldNormal );
		}
		#pragma unroll_loop_end
	#endif
#endif
#if defined( RE_IndirectSpecular )
	vec3 radiance = vec3( 0.0 );
	vec3 clearcoatRadiance = vec3( 0.0 );
#endif`,rx=`#if defined( RE_IndirectDiffuse )
	#ifdef USE_LIGHTMAP
		vec4 lightMapTexel = texture2D( lightMap, vLightMapUv );
		vec3 lightMapIrradiance = lightMapTexel.rgb * lightMapIntensity;
		irradiance += lightMapIrradiance;
	#endif
	#if defined( USE_ENVMAP ) && defined( ENVMAP_TYPE_PMREM )
		#if defined( STANDARD ) || defined( LAMBERT ) || defined( PHONG )
			iblIrradiance += getIBLIrradiance( geometryNormal );
		#endif
	#endif
#endif
#if defined( USE_ENVMAP ) && defined( RE_IndirectSpecular )
	#ifdef USE_ANISOTROPY
		vec3 iblRadiance = getIBLAnisotropyRadiance( geometryViewDir, geometryNormal, material.roughness, material.anisotropyB, material.anisotropy );
	#else
		vec3 iblRadiance = getIBLRadiance( geometryViewDir, geometryNormal, material.roughness );
	#endif
	#ifdef USE_RETROREFLECTION
		#ifdef USE_ANISOTROPY
			vec3 retroIBLRadiance = getIBLAnisotropyRetroRadiance( geometryViewDir, geometryNormal, material.roughness, material.anisotropyB, material.anisotropy );
		#else
			vec3 retroIBLRadiance = getIBLRetroRadiance( geometryViewDir, geometryNormal, material.roughness );
		#endif
		iblRadiance = mix( iblRadiance, retroIBLRadiance, saturate( material.retroreflectivity ) );
	#endif
	radiance += iblRadiance;
	#ifdef USE_CLEARCOAT
		clearcoatRadiance += getIBLRadiance( geometryViewDir, geometryClearcoatNormal, material.clearcoatRoughness );
	#endif
#endif`,ox=`#if defined( RE_IndirectDiffuse )
	#if defined( LAMBERT ) || defined( PHONG )
		irradiance += iblIrradiance;
	#endif
	RE_IndirectDiffuse( irradiance, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
#endif
#if defined( RE_IndirectSpecular )
	RE_IndirectSpecular( radiance, iblIrradiance, clearcoatRadiance, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
#endif`,ax=`#if NUM_LIGHT_PROBE_GRIDS > 0
uniform highp sampler3D probesSH[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesMin[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesMax[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesResolution[ NUM_LIGHT_PROBE_GRIDS ];
bool isInsideLightProbeGrid( vec3 worldPos, vec3 worldNormal, vec3 probesMin, vec3 probesMax, vec3 probesResolution ) {
	vec3 spacing = ( probesMax - probesMin ) / probesResolution;
	vec3 samplePos = worldPos + worldNormal * spacing * 0.5;
	vec3 margin = spacing * 0.01;
	return all( greaterThanEqual( samplePos, probesMin - margin ) ) && all( lessThanEqual( samplePos, probesMax + margin ) );
}
vec3 getLightProbeGridIrradiance( highp sampler3D probesSH, vec3 probesMin, vec3 probesMax, vec3 probesResolution, vec3 worldPos, vec3 worldNormal ) {
	vec3 res = probesResolution;
	vec3 gridRange = probesMax - probesMin;
	vec3 probeSpacing = gridRange / res;
	vec3 samplePos = worldPos + worldNormal * probeSpacing * 0.5;
	vec3 uvw = clamp( ( samplePos - probesMin ) / gridRange, 0.5 / res, 1.0 - 0.5 / res );
	float nz          = res.z;
	float paddedSlices = nz + 2.0;
	float atlasDepth  = 7.0 * paddedSlices;
	float uvZBase     = uvw.z * nz + 1.0;
	vec4 s0 = texture( probesSH, vec3( uvw.xy, ( uvZBase                       ) / atlasDepth ) );
	vec4 s1 = texture( probesSH, vec3( uvw.xy, ( uvZBase +       paddedSlices   ) / atlasDepth ) );
	vec4 s2 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 2.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s3 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 3.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s4 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 4.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s5 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 5.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s6 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 6.0 * paddedSlices   ) / atlasDepth ) );
	vec3 c0 = s0.xyz;
	vec3 c1 = vec3( s0.w, s1.xy );
	vec3 c2 = vec3( s1.zw, s2.x );
	vec3 c3 = s2.yzw;
	vec3 c4 = s3.xyz;
	vec3 c5 = vec3( s3.w, s4.xy );
	vec3 c6 = vec3( s4.zw, s5.x );
	vec3 c7 = s5.yzw;
	vec3 c8 = s6.xyz;
	float x = worldNormal.x, y = worldNormal.y, z = worldNormal.z;
	vec3 result = c0 * 0.886227;
	result += c1 * 2.0 * 0.511664 * y;
	result += c2 * 2.0 * 0.511664 * z;
	result += c3 * 2.0 * 0.511664 * x;
	result += c4 * 2.0 * 0.429043 * x * y;
	result += c5 * 2.0 * 0.429043 * y * z;
	result += c6 * ( 0.743125 * z * z - 0.247708 );
	result += c7 * 2.0 * 0.429043 * x * z;
	result += c8 * 0.429043 * ( x * x - y * y );
	return max( result, vec3( 0.0 ) );
}
#endif`,lx=`#if defined( USE_LOGARITHMIC_DEPTH_BUFFER )
	gl_FragDepth = vIsPerspective == 0.0 ? gl_FragCoord.z : log2( vFragDepth ) * logDepthBufFC * 0.5;
#endif`,cx=`#if defined( USE_LOGARITHMIC_DEPTH_BUFFER )
	uniform float logDepthBufFC;
	varying float vFragDepth;
	varying float vIsPerspective;
#endif`,ux=`#ifdef USE_LOGARITHMIC_DEPTH_BUFFER
	varying float vFragDepth;
	varying float vIsPerspective;
#endif`,hx=`#ifdef USE_LOGARITHMIC_DEPTH_BUFFER
	vFragDepth = 1.0 + gl_Position.w;
	vIsPerspective = float( isPerspectiveMatrix( projectionMatrix ) );
#endif`,fx=`#ifdef USE_MAP
	vec4 sampledDiffuseColor = texture2D( map, vMapUv );
	#ifdef DECODE_VIDEO_TEXTURE
		sampledDiffuseColor = sRGBTransferEOTF( sampledDiffuseColor );
	#endif
	diffuseColor *= sampledDiffuseColor;
#endif`,dx=`#ifdef USE_MAP
	uniform sampler2D map;
#endif`,px=`#if defined( USE_MAP ) || defined( USE_ALPHAMAP )
	#if defined( USE_POINTS_UV )
		vec2 uv = vUv;
	#else
		vec2 uv = ( uvTransform * vec3( gl_PointCoord.x, 1.0 - gl_PointCoord.y, 1 ) ).xy;
	#endif
#endif
#ifdef USE_MAP
	diffuseColor *= texture2D( map, uv );
#endif
#ifdef USE_ALPHAMAP
	diffuseColor.a *= texture2D( alphaMap, uv ).g;
#endif`,mx=`#if defined( USE_POINTS_UV )
	varying vec2 vUv;
#else
	#if defined( USE_MAP ) || defined( USE_ALPHAMAP )
		uniform mat3 uvTransform;
	#endif
#endif
#ifdef USE_MAP
	uniform sampler2D map;
#endif
#ifdef USE_ALPHAMAP
	uniform sampler2D alphaMap;
#endif`,gx=`float metalnessFactor = metalness;
#ifdef USE_METALNESSMAP
	vec4 texelMetalness = texture2D( metalnessMap, vMetalnessMapUv );
	metalnessFactor *= texelMetalness.b;
#endif`,xx=`#ifdef USE_METALNESSMAP
	uniform sampler2D metalnessMap;
#endif`,_x=`#ifdef USE_INSTANCING_MORPH
	float morphTargetInfluences[ MORPHTARGETS_COUNT ];
	float morphTargetBaseInfluence = texelFetch( morphTexture, ivec2( 0, gl_InstanceID ), 0 ).r;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		morphTargetInfluences[i] =  texelFetch( morphTexture, ivec2( i + 1, gl_InstanceID ), 0 ).r;
	}
#endif`,yx=`#if defined( USE_MORPHCOLORS )
	#if defined( USE_COLOR_ALPHA )
		vColor *= morphTargetBaseInfluence;
	#elif defined( USE_COLOR )
		vColor.rgb *= morphTargetBaseInfluence;
	#endif
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		#if defined( USE_COLOR_ALPHA )
			if ( morphTargetInfluences[ i ] != 0.0 ) vColor += getMorph( gl_VertexID, i, 2 ) * morphTargetInfluences[ i ];
		#elif defined( USE_COLOR )
			if ( morphTargetInfluences[ i ] != 0.0 ) vColor.rgb += getMorph( gl_VertexID, i, 2 ).rgb * morphTargetInfluences[ i ];
		#endif
	}
#endif`,vx=`#ifdef USE_MORPHNORMALS
	objectNormal *= morphTargetBaseInfluence;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		if ( morphTargetInfluences[ i ] != 0.0 ) objectNormal += getMorph( gl_VertexID, i, 1 ).xyz * morphTargetInfluences[ i ];
	}
#endif`,Mx=`#ifdef USE_MORPHTARGETS
	#ifndef USE_INSTANCING_MORPH
		uniform float morphTargetBaseInfluence;
		uniform float morphTargetInfluences[ MORPHTARGETS_COUNT ];
	#endif
	uniform sampler2DArray morphTargetsTexture;
	uniform ivec2 morphTargetsTextureSize;
	vec4 getMorph( const in int vertexIndex, const in int morphTargetIndex, const in int offset ) {
		int texelIndex = vertexIndex * MORPHTARGETS_TEXTURE_STRIDE + offset;
		int y = texelIndex / morphTargetsTextureSize.x;
		int x = texelIndex - y * morphTargetsTextureSize.x;
		ivec3 morphUV = ivec3( x, y, morphTargetIndex );
		return texelFetch( morphTargetsTexture, morphUV, 0 );
	}
#endif`,Sx=`#ifdef USE_MORPHTARGETS
	transformed *= morphTargetBaseInfluence;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		if ( morphTargetInfluences[ i ] != 0.0 ) transformed += getMorph( gl_VertexID, i, 0 ).xyz * morphTargetInfluences[ i ];
	}
#endif`,bx=`float faceDirection = gl_FrontFacing ? 1.0 : - 1.0;
#ifdef FLAT_SHADED
	vec3 fdx = dFdx( vViewPosition );
	vec3 fdy = dFdy( vViewPosition );
	vec3 normal = normalize( cross( fdx, fdy ) );
#else
	vec3 normal = normalize( vNormal );
	#ifdef DOUBLE_SIDED
		normal *= faceDirection;
	#endif
#endif
#if defined( USE_NORMALMAP_TANGENTSPACE ) || defined( USE_CLEARCOAT_NORMALMAP ) || defined( USE_ANISOTROPY )
	#ifdef USE_TANGENT
		mat3 tbn = mat3( normalize( vTangent ), normalize( vBitangent ), normal );
	#else
		mat3 tbn = getTangentFrame( - vViewPosition, normal,
		#if defined( USE_NORMALMAP )
			vNormalMapUv
		#elif defined( USE_CLEARCOAT_NORMALMAP )
			vClearcoatNormalMapUv
		#else
			vUv
		#endif
		);
	#endif
	#ifdef DOUBLE_SIDED
		tbn[0] *= faceDirection;
		tbn[1] *= faceDirection;
	#endif
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	#ifdef USE_TANGENT
		mat3 tbn2 = mat3( normalize( vTangent ), normalize( vBitangent ), normal );
	#else
		mat3 tbn2 = getTangentFrame( - vViewPosition, normal, vClearcoatNormalMapUv );
	#endif
	#ifdef DOUBLE_SIDED
		tbn2[0] *= faceDirection;
		tbn2[1] *= faceDirection;
	#endif
#endif
vec3 nonPerturbedNormal = normal;`,wx=`#ifdef USE_NORMALMAP_OBJECTSPACE
	normal = texture2D( normalMap, vNormalMapUv ).xyz * 2.0 - 1.0;
	#ifdef FLIP_SIDED
		normal = - normal;
	#endif
	#ifdef DOUBLE_SIDED
		normal = normal * faceDirection;
	#endif
	normal = normalize( normalMatrix * normal );
#elif defined( USE_NORMALMAP_TANGENTSPACE )
	vec3 mapN = texture2D( normalMap, vNormalMapUv ).xyz * 2.0 - 1.0;
	#if defined( USE_PACKED_NORMALMAP )
		mapN = vec3( mapN.xy, sqrt( saturate( 1.0 - dot( mapN.xy, mapN.xy ) ) ) );
	#endif
	mapN.xy *= normalScale;
	normal = normalize( tbn * mapN );
#elif defined( USE_BUMPMAP )
	normal = perturbNormalArb( - vViewPosition, normal, dHdxy_fwd(), faceDirection );
#endif`,Ax=`#ifndef FLAT_SHADED
	varying vec3 vNormal;
	#ifdef USE_TANGENT
		varying vec3 vTangent;
		varying vec3 vBitangent;
	#endif
#endif`,Tx=`#ifndef FLAT_SHADED
	varying vec3 vNormal;
	#ifdef USE_TANGENT
		varying vec3 vTangent;
		varying vec3 vBitangent;
	#endif
#endif`,Ex=`#ifndef FLAT_SHADED
	vNormal = normalize( transformedNormal );
	#ifdef USE_TANGENT
		vTangent = normalize( transformedTangent );
		vBitangent = normalize( cross( vNormal, vTangent ) * tangent.w );
		#ifdef FLIP_SIDED
			vBitangent = - vBitangent;
		#endif
	#endif
#endif`,Rx=`#ifdef USE_NORMALMAP
	uniform sampler2D normalMap;
	uniform vec2 normalScale;
#endif
#ifdef USE_NORMALMAP_OBJECTSPACE
	uniform mat3 normalMatrix;
#endif
#if ! defined ( USE_TANGENT ) && ( defined ( USE_NORMALMAP_TANGENTSPACE ) || defined ( USE_CLEARCOAT_NORMALMAP ) || defined( USE_ANISOTROPY ) )
	mat3 getTangentFrame( vec3 eye_pos, vec3 surf_norm, vec2 uv ) {
		vec3 q0 = dFdx( eye_pos.xyz );
		vec3 q1 = dFdy( eye_pos.xyz );
		vec2 st0 = dFdx( uv.st );
		vec2 st1 = dFdy( uv.st );
		vec3 N = surf_norm;
		vec3 q1perp = cross( q1, N );
		vec3 q0perp = cross( N, q0 );
		vec3 T = q1perp * st0.x + q0perp * st1.x;
		vec3 B = q1perp * st0.y + q0perp * st1.y;
		float det = max( dot( T, T ), dot( B, B ) );
		float scale = ( det == 0.0 ) ? 0.0 : inversesqrt( det );
		return mat3( T * scale, B * scale, N );
	}
#endif`,Cx=`#ifdef USE_CLEARCOAT
	vec3 clearcoatNormal = nonPerturbedNormal;
#endif`,Px=`#ifdef USE_CLEARCOAT_NORMALMAP
	vec3 clearcoatMapN = texture2D( clearcoatNormalMap, vClearcoatNormalMapUv ).xyz * 2.0 - 1.0;
	clearcoatMapN.xy *= clearcoatNormalScale;
	clearcoatNormal = normalize( tbn2 * clearcoatMapN );
#endif`,Ix=`#ifdef USE_CLEARCOATMAP
	uniform sampler2D clearcoatMap;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	uniform sampler2D clearcoatNormalMap;
	uniform vec2 clearcoatNormalScale;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	uniform sampler2D clearcoatRoughnessMap;
#endif`,Lx=`#ifdef USE_IRIDESCENCEMAP
	uniform sampler2D iridescenceMap;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	uniform sampler2D iridescenceThicknessMap;
#endif`,Nx=`#ifdef OPAQUE
diffuseColor.a = 1.0;
#endif
#ifdef USE_TRANSMISSION
diffuseColor.a *= material.transmissionAlpha;
#endif
gl_FragColor = vec4( outgoingLight, diffuseColor.a );`,Dx=`vec3 packNormalToRGB( const in vec3 normal ) {
	return normalize( normal ) * 0.5 + 0.5;
}
vec3 unpackRGBToNormal( const in vec3 rgb ) {
	return 2.0 * rgb.xyz - 1.0;
}
const float PackUpscale = 256. / 255.;const float UnpackDownscale = 255. / 256.;const float ShiftRight8 = 1. / 256.;
const float Inv255 = 1. / 255.;
const vec4 PackFactors = vec4( 1.0, 256.0, 256.0 * 256.0, 256.0 * 256.0 * 256.0 );
const vec2 UnpackFactors2 = vec2( UnpackDownscale, 1.0 / PackFactors.g );
const vec3 UnpackFactors3 = vec3( UnpackDownscale / PackFactors.rg, 1.0 / PackFactors.b );
const vec4 UnpackFactors4 = vec4( UnpackDownscale / PackFactors.rgb, 1.0 / PackFactors.a );
vec4 packDepthToRGBA( const in float v ) {
	if( v <= 0.0 )
		return vec4( 0., 0., 0., 0. );
	if( v >= 1.0 )
		return vec4( 1., 1., 1., 1. );
	float vuf;
	float af = modf( v * PackFactors.a, vuf );
	float bf = modf( vuf * ShiftRight8, vuf );
	float gf = modf( vuf * ShiftRight8, vuf );
	return vec4( vuf * Inv255, gf * PackUpscale, bf * PackUpscale, af );
}
vec3 packDepthToRGB( const in float v ) {
	if( v <= 0.0 )
		return vec3( 0., 0., 0. );
	if( v >= 1.0 )
		return vec3( 1., 1., 1. );
	float vuf;
	float bf = modf( v * PackFactors.b, vuf );
	float gf = modf( vuf * ShiftRight8, vuf );
	return vec3( vuf * Inv255, gf * PackUpscale, bf );
}
vec2 packDepthToRG( const in float v ) {
	if( v <= 0.0 )
		return vec2( 0., 0. );
	if( v >= 1.0 )
		return vec2( 1., 1. );
	float vuf;
	float gf = modf( v * 256., vuf );
	return vec2( vuf * Inv255, gf );
}
float unpackRGBAToDepth( const in vec4 v ) {
	return dot( v, UnpackFactors4 );
}
float unpackRGBToDepth( const in vec3 v ) {
	return dot( v, UnpackFactors3 );
}
float unpackRGToDepth( const in vec2 v ) {
	return v.r * UnpackFactors2.r + v.g * UnpackFactors2.g;
}
vec4 pack2HalfToRGBA( const in vec2 v ) {
	vec4 r = vec4( v.x, fract( v.x * 255.0 ), v.y, fract( v.y * 255.0 ) );
	return vec4( r.x - r.y / 255.0, r.y, r.z - r.w / 255.0, r.w );
}
vec2 unpackRGBATo2Half( const in vec4 v ) {
	return vec2( v.x + ( v.y / 255.0 ), v.z + ( v.w / 255.0 ) );
}
float viewZToOrthographicDepth( const in float viewZ, const in float near, const in float far ) {
	return ( viewZ + near ) / ( near - far );
}
float orthographicDepthToViewZ( const in float depth, const in float near, const in float far ) {
	#ifdef USE_REVERSED_DEPTH_BUFFER
	
		return depth * ( far - near ) - far;
	#else
		return depth * ( near - far ) - near;
	#endif
}
float viewZToPerspectiveDepth( const in float viewZ, const in float near, const in float far ) {
	return ( ( near + viewZ ) * far ) / ( ( far - near ) * viewZ );
}
float perspectiveDepthToViewZ( const in float depth, const in float near, const in float far ) {
	
	#ifdef USE_REVERSED_DEPTH_BUFFER
		return ( near * far ) / ( ( near - far ) * depth - near );
	#else
		return ( near * far ) / ( ( far - near ) * depth - far );
	#endif
}`,Ux=`#ifdef PREMULTIPLIED_ALPHA
	gl_FragColor.rgb *= gl_FragColor.a;
#endif`,Fx=`vec4 mvPosition = vec4( transformed, 1.0 );
#ifdef USE_BATCHING
	mvPosition = batchingMatrix * mvPosition;
#endif
#ifdef USE_INSTANCING
	mvPosition = instanceMatrix * mvPosition;
#endif
mvPosition = modelViewMatrix * mvPosition;
gl_Position = projectionMatrix * mvPosition;`,Ox=`#ifdef DITHERING
	gl_FragColor.rgb = dithering( gl_FragColor.rgb );
#endif`,Bx=`#ifdef DITHERING
	vec3 dithering( vec3 color ) {
		float grid_position = rand( gl_FragCoord.xy );
		vec3 dither_shift_RGB = vec3( 0.25 / 255.0, -0.25 / 255.0, 0.25 / 255.0 );
		dither_shift_RGB = mix( 2.0 * dither_shift_RGB, -2.0 * dither_shift_RGB, grid_position );
		return color + dither_shift_RGB;
	}
#endif`,zx=`float roughnessFactor = roughness;
#ifdef USE_ROUGHNESSMAP
	vec4 texelRoughness = texture2D( roughnessMap, vRoughnessMapUv );
	roughnessFactor *= texelRoughness.g;
#endif`,kx=`#ifdef USE_ROUGHNESSMAP
	uniform sampler2D roughnessMap;
#endif`,Vx=`#if NUM_SPOT_LIGHT_COORDS > 0
	varying vec4 vSpotLightCoord[ NUM_SPOT_LIGHT_COORDS ];
#endif
#if NUM_SPOT_LIGHT_MAPS > 0
	uniform sampler2D spotLightMap[ NUM_SPOT_LIGHT_MAPS ];
#endif
#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
		#define SUN_LIGHT_CASCADES 2
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow sunShadowMap[ NUM_SUN_LIGHT_SHADOWS ];
		#else
			uniform sampler2D sunShadowMap[ NUM_SUN_LIGHT_SHADOWS ];
		#endif
		uniform mat4 sunShadowMatrix[ NUM_SUN_LIGHT_SHADOWS * SUN_LIGHT_CASCADES ];
		uniform vec4 sunShadowCascade[ NUM_SUN_LIGHT_SHADOWS * SUN_LIGHT_CASCADES ];
		varying vec4 vSunShadowWorldPosition;
		varying vec3 vSunShadowWorldNormal;
		struct SunLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SunLightShadow sunLightShadows[ NUM_SUN_LIGHT_SHADOWS ];
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow directionalShadowMap[ NUM_DIR_LIGHT_SHADOWS ];
		#else
			uniform sampler2D directionalShadowMap[ NUM_DIR_LIGHT_SHADOWS ];
		#endif
		varying vec4 vDirectionalShadowCoord[ NUM_DIR_LIGHT_SHADOWS ];
		struct DirectionalLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform DirectionalLightShadow directionalLightShadows[ NUM_DIR_LIGHT_SHADOWS ];
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow spotShadowMap[ NUM_SPOT_LIGHT_SHADOWS ];
		#else
			uniform sampler2D spotShadowMap[ NUM_SPOT_LIGHT_SHADOWS ];
		#endif
		struct SpotLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SpotLightShadow spotLightShadows[ NUM_SPOT_LIGHT_SHADOWS ];
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform samplerCubeShadow pointShadowMap[ NUM_POINT_LIGHT_SHADOWS ];
		#elif defined( SHADOWMAP_TYPE_BASIC )
			uniform samplerCube pointShadowMap[ NUM_POINT_LIGHT_SHADOWS ];
		#endif
		varying vec4 vPointShadowCoord[ NUM_POINT_LIGHT_SHADOWS ];
		struct PointLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
			float shadowCameraNear;
			float shadowCameraFar;
		};
		uniform PointLightShadow pointLightShadows[ NUM_POINT_LIGHT_SHADOWS ];
	#endif
	#if defined( SHADOWMAP_TYPE_PCF )
		float interleavedGradientNoise( vec2 position ) {
			return fract( 52.9829189 * fract( dot( position, vec2( 0.06711056, 0.00583715 ) ) ) );
		}
		vec2 vogelDiskSample( int sampleIndex, int samplesCount, float phi ) {
			const float goldenAngle = 2.399963229728653;
			float r = sqrt( ( float( sampleIndex ) + 0.5 ) / float( samplesCount ) );
			float theta = float( sampleIndex ) * goldenAngle + phi;
			return vec2( cos( theta ), sin( theta ) ) * r;
		}
	#endif
	#if defined( SHADOWMAP_TYPE_PCF )
		float getShadow( sampler2DShadow shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				vec2 texelSize = vec2( 1.0 ) / shadowMapSize;
				vec2 radius = shadowRadius * texelSize;
				float phi = interleavedGradientNoise( gl_FragCoord.xy ) * PI2;
				shadow = (
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 0, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 1, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 2, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 3, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 4, 5, phi ) * radius, shadowCoord.z ) )
				) * 0.2;
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#elif defined( SHADOWMAP_TYPE_VSM )
		float getShadow( sampler2D shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				vec2 distribution = texture2D( shadowMap, shadowCoord.xy ).rg;
				float mean = distribution.x;
				float variance = distribution.y * distribution.y;
				#ifdef USE_REVERSED_DEPTH_BUFFER
					float hard_shadow = step( mean, shadowCoord.z );
				#else
					float hard_shadow = step( shadowCoord.z, mean );
				#endif
				
				if ( hard_shadow == 1.0 ) {
					shadow = 1.0;
				} else {
					variance = max( variance, 0.0000001 );
					float d = shadowCoord.z - mean;
					float p_max = variance / ( variance + d * d );
					p_max = clamp( ( p_max - 0.3 ) / 0.65, 0.0, 1.0 );
					shadow = max( hard_shadow, p_max );
				}
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#else
		float getShadow( sampler2D shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				float depth = texture2D( shadowMap, shadowCoord.xy ).r;
				#ifdef USE_REVERSED_DEPTH_BUFFER
					shadow = step( depth, shadowCoord.z );
				#else
					shadow = step( shadowCoord.z, depth );
				#endif
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#endif
	#if NUM_SUN_LIGHT_SHADOWS > 0
		float getSunShadow(
			#if defined( SHADOWMAP_TYPE_PCF )
				sampler2DShadow shadowMap,
			#else
				sampler2D shadowMap,
			#endif
			SunLightShadow sunLightShadow,
			int shadowIndex
		) {
			vec4 shadowWorldPosition = vec4( vSunShadowWorldPosition.xyz + vSunShadowWorldNormal * sunLightShadow.shadowNormalBias, 1.0 );
			float viewDepth = vSunShadowWorldPosition.w;
			int cascadeOffset = shadowIndex * SUN_LIGHT_CASCADES;
			float shadow = 1.0;
			for ( int i = SUN_LIGHT_CASCADES - 1; i >= 0; i -- ) {
				vec4 cascade = sunShadowCascade[ cascadeOffset + i ];
				if ( viewDepth >= cascade.x && viewDepth < cascade.y ) {
					float cascadeShadow = getShadow(
						shadowMap,
						sunLightShadow.shadowMapSize,
						sunLightShadow.shadowIntensity,
						sunLightShadow.shadowBias,
						sunLightShadow.shadowRadius,
						sunShadowMatrix[ cascadeOffset + i ] * shadowWorldPosition
					);
					shadow = mix( cascadeShadow, shadow, smoothstep( cascade.z, cascade.y, viewDepth ) );
				}
			}
			return shadow;
		}
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
	#if defined( SHADOWMAP_TYPE_PCF )
	float getPointShadow( samplerCubeShadow shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord, float shadowCameraNear, float shadowCameraFar ) {
		float shadow = 1.0;
		vec3 lightToPosition = shadowCoord.xyz;
		vec3 bd3D = normalize( lightToPosition );
		vec3 absVec = abs( lightToPosition );
		float viewSpaceZ = max( max( absVec.x, absVec.y ), absVec.z );
		if ( viewSpaceZ - shadowCameraFar <= 0.0 && viewSpaceZ - shadowCameraNear >= 0.0 ) {
			float lightDistance = length( lightToPosition );
			float depthRange = shadowCameraFar - shadowCameraNear;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				float depthA = - shadowCameraNear / depthRange - shadowBias;
				float depthB = shadowCameraNear * shadowCameraFar / ( depthRange * lightDistance );
			#else
				float depthA = shadowCameraFar / depthRange + shadowBias;
				float depthB = - shadowCameraNear * shadowCameraFar / ( depthRange * lightDistance );
			#endif
			float texelSize = shadowRadius / shadowMapSize.x;
			vec3 absDir = abs( bd3D );
			vec3 tangent = absDir.x > absDir.z ? vec3( 0.0, 1.0, 0.0 ) : vec3( 1.0, 0.0, 0.0 );
			tangent = normalize( cross( bd3D, tangent ) );
			vec3 bitangent = cross( bd3D, tangent );
			float phi = interleavedGradientNoise( gl_FragCoord.xy ) * PI2;
			shadow = 0.0;
			for ( int i = 0; i < 5; i ++ ) {
				vec2 offset = vogelDiskSample( i, 5, phi );
				vec3 direction = bd3D + ( tangent * offset.x + bitangent * offset.y ) * texelSize;
				vec3 absDirection = abs( direction );
				float dp = depthA + depthB / max( max( absDirection.x, absDirection.y ), absDirection.z );
				shadow += texture( shadowMap, vec4( direction, dp ) );
			}
			shadow *= 0.2;
		}
		return mix( 1.0, shadow, shadowIntensity );
	}
	#elif defined( SHADOWMAP_TYPE_BASIC )
	float getPointShadow( samplerCube shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord, float shadowCameraNear, float shadowCameraFar ) {
		float shadow = 1.0;
		vec3 lightToPosition = shadowCoord.xyz;
		vec3 absVec = abs( lightToPosition );
		float viewSpaceZ = max( max( absVec.x, absVec.y ), absVec.z );
		if ( viewSpaceZ - shadowCameraFar <= 0.0 && viewSpaceZ - shadowCameraNear >= 0.0 ) {
			float dp = ( shadowCameraFar * ( viewSpaceZ - shadowCameraNear ) ) / ( viewSpaceZ * ( shadowCameraFar - shadowCameraNear ) );
			dp += shadowBias;
			vec3 bd3D = normalize( lightToPosition );
			float depth = textureCube( shadowMap, bd3D ).r;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				depth = 1.0 - depth;
			#endif
			shadow = step( dp, depth );
		}
		return mix( 1.0, shadow, shadowIntensity );
	}
	#endif
	#endif
#endif`,Gx=`#if NUM_SPOT_LIGHT_COORDS > 0
	uniform mat4 spotLightMatrix[ NUM_SPOT_LIGHT_COORDS ];
	varying vec4 vSpotLightCoord[ NUM_SPOT_LIGHT_COORDS ];
#endif
#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
		varying vec4 vSunShadowWorldPosition;
		varying vec3 vSunShadowWorldNormal;
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		uniform mat4 directionalShadowMatrix[ NUM_DIR_LIGHT_SHADOWS ];
		varying vec4 vDirectionalShadowCoord[ NUM_DIR_LIGHT_SHADOWS ];
		struct DirectionalLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform DirectionalLightShadow directionalLightShadows[ NUM_DIR_LIGHT_SHADOWS ];
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
		struct SpotLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SpotLightShadow spotLightShadows[ NUM_SPOT_LIGHT_SHADOWS ];
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		uniform mat4 pointShadowMatrix[ NUM_POINT_LIGHT_SHADOWS ];
		varying vec4 vPointShadowCoord[ NUM_POINT_LIGHT_SHADOWS ];
		struct PointLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
			float shadowCameraNear;
			float shadowCameraFar;
		};
		uniform PointLightShadow pointLightShadows[ NUM_POINT_LIGHT_SHADOWS ];
	#endif
#endif`,Hx=`#if ( defined( USE_SHADOWMAP ) && ( NUM_DIR_LIGHT_SHADOWS > 0 || NUM_SUN_LIGHT_SHADOWS > 0 || NUM_POINT_LIGHT_SHADOWS > 0 ) ) || ( NUM_SPOT_LIGHT_COORDS > 0 )
	#ifdef HAS_NORMAL
		vec3 shadowWorldNormal = transformNormalByInverseViewMatrix( transformedNormal, viewMatrix );
	#else
		vec3 shadowWorldNormal = vec3( 0.0 );
	#endif
	vec4 shadowWorldPosition;
#endif
#if defined( USE_SHADOWMAP )
	#if NUM_SUN_LIGHT_SHADOWS > 0
		vSunShadowWorldPosition = vec4( worldPosition.xyz, - mvPosition.z );
		vSunShadowWorldNormal = shadowWorldNormal;
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_DIR_LIGHT_SHADOWS; i ++ ) {
			shadowWorldPosition = worldPosition + vec4( shadowWorldNormal * directionalLightShadows[ i ].shadowNormalBias, 0 );
			vDirectionalShadowCoord[ i ] = directionalShadowMatrix[ i ] * shadowWorldPosition;
		}
		#pragma unroll_loop_end
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_POINT_LIGHT_SHADOWS; i ++ ) {
			shadowWorldPosition = worldPosition + vec4( shadowWorldNormal * pointLightShadows[ i ].shadowNormalBias, 0 );
			vPointShadowCoord[ i ] = pointShadowMatrix[ i ] * shadowWorldPosition;
		}
		#pragma unroll_loop_end
	#endif
#endif
#if NUM_SPOT_LIGHT_COORDS > 0
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHT_COORDS; i ++ ) {
		shadowWorldPosition = worldPosition;
		#if ( defined( USE_SHADOWMAP ) && UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
			shadowWorldPosition.xyz += shadowWorldNormal * spotLightShadows[ i ].shadowNormalBias;
		#endif
		vSpotLightCoord[ i ] = spotLightMatrix[ i ] * shadowWorldPosition;
	}
	#pragma unroll_loop_end
#endif`,Wx=`float getShadowMask() {
	float shadow = 1.0;
	#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
	SunLightShadow sunLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SUN_LIGHT_SHADOWS; i ++ ) {
		sunLight = sunLightShadows[ i ];
		shadow *= receiveShadow ? getSunShadow( sunShadowMap[ i ], sunLight, UNROLLED_LOOP_INDEX ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
	DirectionalLightShadow directionalLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_DIR_LIGHT_SHADOWS; i ++ ) {
		directionalLight = directionalLightShadows[ i ];
		shadow *= receiveShadow ? getShadow( directionalShadowMap[ i ], directionalLight.shadowMapSize, directionalLight.shadowIntensity, directionalLight.shadowBias, directionalLight.shadowRadius, vDirectionalShadowCoord[ i ] ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
	SpotLightShadow spotLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHT_SHADOWS; i ++ ) {
		spotLight = spotLightShadows[ i ];
		shadow *= receiveShadow ? getShadow( spotShadowMap[ i ], spotLight.shadowMapSize, spotLight.shadowIntensity, spotLight.shadowBias, spotLight.shadowRadius, vSpotLightCoord[ i ] ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0 && ( defined( SHADOWMAP_TYPE_PCF ) || defined( SHADOWMAP_TYPE_BASIC ) )
	PointLightShadow pointLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_POINT_LIGHT_SHADOWS; i ++ ) {
		pointLight = pointLightShadows[ i ];
		shadow *= receiveShadow ? getPointShadow( pointShadowMap[ i ], pointLight.shadowMapSize, pointLight.shadowIntensity, pointLight.shadowBias, pointLight.shadowRadius, vPointShadowCoord[ i ], pointLight.shadowCameraNear, pointLight.shadowCameraFar ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#endif
	return shadow;
}`,Xx=`#ifdef USE_SKINNING
	mat4 boneMatX = getBoneMatrix( skinIndex.x );
	mat4 boneMatY = getBoneMatrix( skinIndex.y );
	mat4 boneMatZ = getBoneMatrix( skinIndex.z );
	mat4 boneMatW = getBoneMatrix( skinIndex.w );
#endif`,qx=`#ifdef USE_SKINNING
	uniform mat4 bindMatrix;
	uniform mat4 bindMatrixInverse;
	uniform highp sampler2D boneTexture;
	mat4 getBoneMatrix( const in float i ) {
		int size = textureSize( boneTexture, 0 ).x;
		int j = int( i ) * 4;
		int x = j % size;
		int y = j / size;
		vec4 v1 = texelFetch( boneTexture, ivec2( x, y ), 0 );
		vec4 v2 = texelFetch( boneTexture, ivec2( x + 1, y ), 0 );
		vec4 v3 = texelFetch( boneTexture, ivec2( x + 2, y ), 0 );
		vec4 v4 = texelFetch( boneTexture, ivec2( x + 3, y ), 0 );
		return mat4( v1, v2, v3, v4 );
	}
#endif`,Yx=`#ifdef USE_SKINNING
	vec4 skinVertex = bindMatrix * vec4( transformed, 1.0 );
	vec4 skinned = vec4( 0.0 );
	skinned += boneMatX * skinVertex * skinWeight.x;
	skinned += boneMatY * skinVertex * skinWeight.y;
	skinned += boneMatZ * skinVertex * skinWeight.z;
	skinned += boneMatW * skinVertex * skinWeight.w;
	transformed = ( bindMatrixInverse * skinned ).xyz;
#endif`,$x=`#ifdef USE_SKINNING
	mat4 skinMatrix = mat4( 0.0 );
	skinMatrix += skinWeight.x * boneMatX;
	skinMatrix += skinWeight.y * boneMatY;
	skinMatrix += skinWeight.z * boneMatZ;
	skinMatrix += skinWeight.w * boneMatW;
	skinMatrix = bindMatrixInverse * skinMatrix * bindMatrix;
	objectNormal = vec4( skinMatrix * vec4( objectNormal, 0.0 ) ).xyz;
	#ifdef USE_TANGENT
		objectTangent = vec4( skinMatrix * vec4( objectTangent, 0.0 ) ).xyz;
	#endif
#endif`,Zx=`float specularStrength;
#ifdef USE_SPECULARMAP
	vec4 texelSpecular = texture2D( specularMap, vSpecularMapUv );
	specularStrength = texelSpecular.r;
#else
	specularStrength = 1.0;
#endif`,Jx=`#ifdef USE_SPECULARMAP
	uniform sampler2D specularMap;
#endif`,Kx=`#if defined( TONE_MAPPING )
	gl_FragColor.rgb = toneMapping( gl_FragColor.rgb );
#endif`,Qx=`#ifndef saturate
#define saturate( a ) clamp( a, 0.0, 1.0 )
#endif
uniform float toneMappingExposure;
vec3 LinearToneMapping( vec3 color ) {
	return saturate( toneMappingExposure * color );
}
vec3 ReinhardToneMapping( vec3 color ) {
	color *= toneMappingExposure;
	return saturate( color / ( vec3( 1.0 ) + color ) );
}
vec3 CineonToneMapping( vec3 color ) {
	color *= toneMappingExposure;
	color = max( vec3( 0.0 ), color - 0.004 );
	return pow( ( color * ( 6.2 * color + 0.5 ) ) / ( color * ( 6.2 * color + 1.7 ) + 0.06 ), vec3( 2.2 ) );
}
vec3 RRTAndODTFit( vec3 v ) {
	vec3 a = v * ( v + 0.0245786 ) - 0.000090537;
	vec3 b = v * ( 0.983729 * v + 0.4329510 ) + 0.238081;
	return a / b;
}
vec3 ACESFilmicToneMapping( vec3 color ) {
	const mat3 ACESInputMat = mat3(
		vec3( 0.59719, 0.07600, 0.02840 ),		vec3( 0.35458, 0.90834, 0.13383 ),
		vec3( 0.04823, 0.01566, 0.83777 )
	);
	const mat3 ACESOutputMat = mat3(
		vec3(  1.60475, -0.10208, -0.00327 ),		vec3( -0.53108,  1.10813, -0.07276 ),
		vec3( -0.07367, -0.00605,  1.07602 )
	);
	color *= toneMappingExposure / 0.6;
	color = ACESInputMat * color;
	color = RRTAndODTFit( color );
	color = ACESOutputMat * color;
	return saturate( color );
}
const mat3 LINEAR_REC2020_TO_LINEAR_SRGB = mat3(
	vec3( 1.6605, - 0.1246, - 0.0182 ),
	vec3( - 0.5876, 1.1329, - 0.1006 ),
	vec3( - 0.0728, - 0.0083, 1.1187 )
);
const mat3 LINEAR_SRGB_TO_LINEAR_REC2020 = mat3(
	vec3( 0.6274, 0.0691, 0.0164 ),
	vec3( 0.3293, 0.9195, 0.0880 ),
	vec3( 0.0433, 0.0113, 0.8956 )
);
vec3 agxDefaultContrastApprox( vec3 x ) {
	vec3 x2 = x * x;
	vec3 x4 = x2 * x2;
	return + 15.5 * x4 * x2
		- 40.14 * x4 * x
		+ 31.96 * x4
		- 6.868 * x2 * x
		+ 0.4298 * x2
		+ 0.1191 * x
		- 0.00232;
}
vec3 AgXToneMapping( vec3 color ) {
	const mat3 AgXInsetMatrix = mat3(
		vec3( 0.856627153315983, 0.137318972929847, 0.11189821299995 ),
		vec3( 0.0951212405381588, 0.761241990602591, 0.0767994186031903 ),
		vec3( 0.0482516061458583, 0.101439036467562, 0.811302368396859 )
	);
	const mat3 AgXOutsetMatrix = mat3(
		vec3( 1.1271005818144368, - 0.1413297634984383, - 0.14132976349843826 ),
		vec3( - 0.11060664309660323, 1.157823702216272, - 0.11060664309660294 ),
		vec3( - 0.016493938717834573, - 0.016493938717834257, 1.2519364065950405 )
	);
	const float AgxMinEv = - 12.47393;	const float AgxMaxEv = 4.026069;
	color *= toneMappingExposure;
	color = LINEAR_SRGB_TO_LINEAR_REC2020 * color;
	color = AgXInsetMatrix * color;
	color = max( color, 1e-10 );	color = log2( color );
	color = ( color - AgxMinEv ) / ( AgxMaxEv - AgxMinEv );
	color = clamp( color, 0.0, 1.0 );
	color = agxDefaultContrastApprox( color );
	color = AgXOutsetMatrix * color;
	color = pow( max( vec3( 0.0 ), color ), vec3( 2.2 ) );
	color = LINEAR_REC2020_TO_LINEAR_SRGB * color;
	color = clamp( color, 0.0, 1.0 );
	return color;
}
vec3 NeutralToneMapping( vec3 color ) {
	const float StartCompression = 0.8 - 0.04;
	const float Desaturation = 0.15;
	color *= toneMappingExposure;
	float x = min( color.r, min( color.g, color.b ) );
	float offset = x < 0.08 ? x - 6.25 * x * x : 0.04;
	color -= offset;
	float peak = max( color.r, max( color.g, color.b ) );
	if ( peak < StartCompression ) return color;
	float d = 1. - StartCompression;
	float newPeak = 1. - d * d / ( peak + d - StartCompression );
	color *= newPeak / peak;
	float g = 1. - 1. / ( Desaturation * ( peak - newPeak ) + 1. );
	return mix( color, vec3( newPeak ), g );
}
vec3 CustomToneMapping( vec3 color ) { return color; }`,jx=`#ifdef USE_TRANSMISSION
	material.transmission = transmission;
	material.transmissionAlpha = 1.0;
	material.thickness = thickness;
	material.attenuationDistance = attenuationDistance;
	material.attenuationColor = attenuationColor;
	#ifdef USE_TRANSMISSIONMAP
		material.transmission *= texture2D( transmissionMap, vTransmissionMapUv ).r;
	#endif
	#ifdef USE_THICKNESSMAP
		material.thickness *= texture2D( thicknessMap, vThicknessMapUv ).g;
	#endif
	vec3 pos = vWorldPosition;
	vec3 v = normalize( cameraPosition - pos );
	vec3 n = transformNormalByInverseViewMatrix( normal, viewMatrix );
	vec4 transmitted = getIBLVolumeRefraction(
		n, v, material.roughness, material.diffuseContribution, material.specularColorBlended, material.specularF90,
		pos, modelMatrix, viewMatrix, projectionMatrix, material.dispersion, material.ior, material.thickness,
		material.attenuationColor, material.attenuationDistance );
	material.transmissionAlpha = mix( material.transmissionAlpha, transmitted.a, material.transmission );
	totalDiffuse = mix( totalDiffuse, transmitted.rgb, material.transmission );
#endif`,t_=`#ifdef USE_TRANSMISSION
	uniform float transmission;
	uniform float thickness;
	uniform float attenuationDistance;
	uniform vec3 attenuationColor;
	#ifdef USE_TRANSMISSIONMAP
		uniform sampler2D transmissionMap;
	#endif
	#ifdef USE_THICKNESSMAP
		uniform sampler2D thicknessMap;
	#endif
	uniform vec2 transmissionSamplerSize;
	uniform sampler2D transmissionSamplerMap;
	uniform mat4 modelMatrix;
	uniform mat4 projectionMatrix;
	varying vec3 vWorldPosition;
	float w0( float a ) {
		return ( 1.0 / 6.0 ) * ( a * ( a * ( - a + 3.0 ) - 3.0 ) + 1.0 );
	}
	float w1( float a ) {
		return ( 1.0 / 6.0 ) * ( a *  a * ( 3.0 * a - 6.0 ) + 4.0 );
	}
	float w2( float a ){
		return ( 1.0 / 6.0 ) * ( a * ( a * ( - 3.0 * a + 3.0 ) + 3.0 ) + 1.0 );
	}
	float w3( float a ) {
		return ( 1.0 / 6.0 ) * ( a * a * a );
	}
	float g0( float a ) {
		return w0( a ) + w1( a );
	}
	float g1( float a ) {
		return w2( a ) + w3( a );
	}
	float h0( float a ) {
		return - 1.0 + w1( a ) / ( w0( a ) + w1( a ) );
	}
	float h1( float a ) {
		return 1.0 + w3( a ) / ( w2( a ) + w3( a ) );
	}
	vec4 bicubic( sampler2D tex, vec2 uv, vec4 texelSize, float lod ) {
		uv = uv * texelSize.zw + 0.5;
		vec2 iuv = floor( uv );
		vec2 fuv = fract( uv );
		float g0x = g0( fuv.x );
		float g1x = g1( fuv.x );
		float h0x = h0( fuv.x );
		float h1x = h1( fuv.x );
		float h0y = h0( fuv.y );
		float h1y = h1( fuv.y );
		vec2 p0 = ( vec2( iuv.x + h0x, iuv.y + h0y ) - 0.5 ) * texelSize.xy;
		vec2 p1 = ( vec2( iuv.x + h1x, iuv.y + h0y ) - 0.5 ) * texelSize.xy;
		vec2 p2 = ( vec2( iuv.x + h0x, iuv.y + h1y ) - 0.5 ) * texelSize.xy;
		vec2 p3 = ( vec2( iuv.x + h1x, iuv.y + h1y ) - 0.5 ) * texelSize.xy;
		return g0( fuv.y ) * ( g0x * textureLod( tex, p0, lod ) + g1x * textureLod( tex, p1, lod ) ) +
			g1( fuv.y ) * ( g0x * textureLod( tex, p2, lod ) + g1x * textureLod( tex, p3, lod ) );
	}
	vec4 textureBicubic( sampler2D sampler, vec2 uv, float lod ) {
		vec2 fLodSize = vec2( textureSize( sampler, int( lod ) ) );
		vec2 cLodSize = vec2( textureSize( sampler, int( lod + 1.0 ) ) );
		vec2 fLodSizeInv = 1.0 / fLodSize;
		vec2 cLodSizeInv = 1.0 / cLodSize;
		vec4 fSample = bicubic( sampler, uv, vec4( fLodSizeInv, fLodSize ), floor( lod ) );
		vec4 cSample = bicubic( sampler, uv, vec4( cLodSizeInv, cLodSize ), ceil( lod ) );
		return mix( fSample, cSample, fract( lod ) );
	}
	vec3 getVolumeTransmissionRay( const in vec3 n, const in vec3 v, const in float thickness, const in float ior, const in mat4 modelMatrix ) {
		vec3 refractionVector = refract( - v, normalize( n ), 1.0 / ior );
		vec3 modelScale;
		modelScale.x = length( vec3( modelMatrix[ 0 ].xyz ) );
		modelScale.y = length( vec3( modelMatrix[ 1 ].xyz ) );
		modelScale.z = length( vec3( modelMatrix[ 2 ].xyz ) );
		return normalize( refractionVector ) * thickness * modelScale;
	}
	float applyIorToRoughness( const in float roughness, const in float ior ) {
		return roughness * clamp( ior * 2.0 - 2.0, 0.0, 1.0 );
	}
	vec4 getTransmissionSample( const in vec2 fragCoord, const in float roughness, const in float ior ) {
		float lod = log2( transmissionSamplerSize.x ) * applyIorToRoughness( roughness, ior );
		return textureBicubic( transmissionSamplerMap, fragCoord.xy, lod );
	}
	vec3 volumeAttenuation( const in float transmissionDistance, const in vec3 attenuationColor, const in float attenuationDistance ) {
		if ( isinf( attenuationDistance ) ) {
			return vec3( 1.0 );
		} else {
			vec3 attenuationCoefficient = -log( attenuationColor ) / attenuationDistance;
			vec3 transmittance = exp( - attenuationCoefficient * transmissionDistance );			return transmittance;
		}
	}
	vec4 getIBLVolumeRefraction( const in vec3 n, const in vec3 v, const in float roughness, const in vec3 diffuseColor,
		const in vec3 specularColor, const in float specularF90, const in vec3 position, const in mat4 modelMatrix,
		const in mat4 viewMatrix, const in mat4 projMatrix, const in float dispersion, const in float ior, const in float thickness,
		const in vec3 attenuationColor, const in float attenuationDistance ) {
		vec4 transmittedLight;
		vec3 transmittance;
		#ifdef USE_DISPERSION
			float halfSpread = ( ior - 1.0 ) * 0.025 * dispersion;
			vec3 iors = vec3( ior - halfSpread, ior, ior + halfSpread );
			for ( int i = 0; i < 3; i ++ ) {
				vec3 transmissionRay = getVolumeTransmissionRay( n, v, thickness, iors[ i ], modelMatrix );
				vec3 refractedRayExit = position + transmissionRay;
				vec4 ndcPos = projMatrix * viewMatrix * vec4( refractedRayExit, 1.0 );
				vec2 refractionCoords = ndcPos.xy / ndcPos.w;
				refractionCoords += 1.0;
				refractionCoords /= 2.0;
				vec4 transmissionSample = getTransmissionSample( refractionCoords, roughness, iors[ i ] );
				transmittedLight[ i ] = transmissionSample[ i ];
				transmittedLight.a += transmissionSample.a;
				transmittance[ i ] = diffuseColor[ i ] * volumeAttenuation( length( transmissionRay ), attenuationColor, attenuationDistance )[ i ];
			}
			transmittedLight.a /= 3.0;
		#else
			vec3 transmissionRay = getVolumeTransmissionRay( n, v, thickness, ior, modelMatrix );
			vec3 refractedRayExit = position + transmissionRay;
			vec4 ndcPos = projMatrix * viewMatrix * vec4( refractedRayExit, 1.0 );
			vec2 refractionCoords = ndcPos.xy / ndcPos.w;
			refractionCoords += 1.0;
			refractionCoords /= 2.0;
			transmittedLight = getTransmissionSample( refractionCoords, roughness, ior );
			transmittance = diffuseColor * volumeAttenuation( length( transmissionRay ), attenuationColor, attenuationDistance );
		#endif
		vec3 attenuatedColor = transmittance * transmittedLight.rgb;
		vec3 F = EnvironmentBRDF( n, v, specularColor, specularF90, roughness );
		float transmittanceFactor = ( transmittance.r + transmittance.g + transmittance.b ) / 3.0;
		return vec4( ( 1.0 - F ) * attenuatedColor, 1.0 - ( 1.0 - transmittedLight.a ) * transmittanceFactor );
	}
#endif`,e_=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	varying vec2 vUv;
#endif
#ifdef USE_MAP
	varying vec2 vMapUv;
#endif
#ifdef USE_ALPHAMAP
	varying vec2 vAlphaMapUv;
#endif
#ifdef USE_LIGHTMAP
	varying vec2 vLightMapUv;
#endif
#ifdef USE_AOMAP
	varying vec2 vAoMapUv;
#endif
#ifdef USE_BUMPMAP
	varying vec2 vBumpMapUv;
#endif
#ifdef USE_NORMALMAP
	varying vec2 vNormalMapUv;
#endif
#ifdef USE_EMISSIVEMAP
	varying vec2 vEmissiveMapUv;
#endif
#ifdef USE_METALNESSMAP
	varying vec2 vMetalnessMapUv;
#endif
#ifdef USE_ROUGHNESSMAP
	varying vec2 vRoughnessMapUv;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	varying vec2 vDiffuseRoughnessMapUv;
#endif
#ifdef USE_ANISOTROPYMAP
	varying vec2 vAnisotropyMapUv;
#endif
#ifdef USE_CLEARCOATMAP
	varying vec2 vClearcoatMapUv;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	varying vec2 vClearcoatNormalMapUv;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	varying vec2 vClearcoatRoughnessMapUv;
#endif
#ifdef USE_IRIDESCENCEMAP
	varying vec2 vIridescenceMapUv;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	varying vec2 vIridescenceThicknessMapUv;
#endif
#ifdef USE_SHEEN_COLORMAP
	varying vec2 vSheenColorMapUv;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	varying vec2 vSheenRoughnessMapUv;
#endif
#ifdef USE_SPECULARMAP
	varying vec2 vSpecularMapUv;
#endif
#ifdef USE_SPECULAR_COLORMAP
	varying vec2 vSpecularColorMapUv;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	varying vec2 vSpecularIntensityMapUv;
#endif
#ifdef USE_TRANSMISSIONMAP
	uniform mat3 transmissionMapTransform;
	varying vec2 vTransmissionMapUv;
#endif
#ifdef USE_THICKNESSMAP
	uniform mat3 thicknessMapTransform;
	varying vec2 vThicknessMapUv;
#endif`,n_=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	varying vec2 vUv;
#endif
#ifdef USE_MAP
	uniform mat3 mapTransform;
	varying vec2 vMapUv;
#endif
#ifdef USE_ALPHAMAP
	uniform mat3 alphaMapTransform;
	varying vec2 vAlphaMapUv;
#endif
#ifdef USE_LIGHTMAP
	uniform mat3 lightMapTransform;
	varying vec2 vLightMapUv;
#endif
#ifdef USE_AOMAP
	uniform mat3 aoMapTransform;
	varying vec2 vAoMapUv;
#endif
#ifdef USE_BUMPMAP
	uniform mat3 bumpMapTransform;
	varying vec2 vBumpMapUv;
#endif
#ifdef USE_NORMALMAP
	uniform mat3 normalMapTransform;
	varying vec2 vNormalMapUv;
#endif
#ifdef USE_DISPLACEMENTMAP
	uniform mat3 displacementMapTransform;
	varying vec2 vDisplacementMapUv;
#endif
#ifdef USE_EMISSIVEMAP
	uniform mat3 emissiveMapTransform;
	varying vec2 vEmissiveMapUv;
#endif
#ifdef USE_METALNESSMAP
	uniform mat3 metalnessMapTransform;
	varying vec2 vMetalnessMapUv;
#endif
#ifdef USE_ROUGHNESSMAP
	uniform mat3 roughnessMapTransform;
	varying vec2 vRoughnessMapUv;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	uniform mat3 diffuseRoughnessMapTransform;
	varying vec2 vDiffuseRoughnessMapUv;
#endif
#ifdef USE_ANISOTROPYMAP
	uniform mat3 anisotropyMapTransform;
	varying vec2 vAnisotropyMapUv;
#endif
#ifdef USE_CLEARCOATMAP
	uniform mat3 clearcoatMapTransform;
	varying vec2 vClearcoatMapUv;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	uniform mat3 clearcoatNormalMapTransform;
	varying vec2 vClearcoatNormalMapUv;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	uniform mat3 clearcoatRoughnessMapTransform;
	varying vec2 vClearcoatRoughnessMapUv;
#endif
#ifdef USE_SHEEN_COLORMAP
	uniform mat3 sheenColorMapTransform;
	varying vec2 vSheenColorMapUv;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	uniform mat3 sheenRoughnessMapTransform;
	varying vec2 vSheenRoughnessMapUv;
#endif
#ifdef USE_IRIDESCENCEMAP
	uniform mat3 iridescenceMapTransform;
	varying vec2 vIridescenceMapUv;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	uniform mat3 iridescenceThicknessMapTransform;
	varying vec2 vIridescenceThicknessMapUv;
#endif
#ifdef USE_SPECULARMAP
	uniform mat3 specularMapTransform;
	varying vec2 vSpecularMapUv;
#endif
#ifdef USE_SPECULAR_COLORMAP
	uniform mat3 specularColorMapTransform;
	varying vec2 vSpecularColorMapUv;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	uniform mat3 specularIntensityMapTransform;
	varying vec2 vSpecularIntensityMapUv;
#endif
#ifdef USE_TRANSMISSIONMAP
	uniform mat3 transmissionMapTransform;
	varying vec2 vTransmissionMapUv;
#endif
#ifdef USE_THICKNESSMAP
	uniform mat3 thicknessMapTransform;
	varying vec2 vThicknessMapUv;
#endif`,i_=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	vUv = vec3( uv, 1 ).xy;
#endif
#ifdef USE_MAP
	vMapUv = ( mapTransform * vec3( MAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ALPHAMAP
	vAlphaMapUv = ( alphaMapTransform * vec3( ALPHAMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_LIGHTMAP
	vLightMapUv = ( lightMapTransform * vec3( LIGHTMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_AOMAP
	vAoMapUv = ( aoMapTransform * vec3( AOMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_BUMPMAP
	vBumpMapUv = ( bumpMapTransform * vec3( BUMPMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_NORMALMAP
	vNormalMapUv = ( normalMapTransform * vec3( NORMALMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_DISPLACEMENTMAP
	vDisplacementMapUv = ( displacementMapTransform * vec3( DISPLACEMENTMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_EMISSIVEMAP
	vEmissiveMapUv = ( emissiveMapTransform * vec3( EMISSIVEMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_METALNESSMAP
	vMetalnessMapUv = ( metalnessMapTransform * vec3( METALNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ROUGHNESSMAP
	vRoughnessMapUv = ( roughnessMapTransform * vec3( ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	vDiffuseRoughnessMapUv = ( diffuseRoughnessMapTransform * vec3( DIFFUSE_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ANISOTROPYMAP
	vAnisotropyMapUv = ( anisotropyMapTransform * vec3( ANISOTROPYMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOATMAP
	vClearcoatMapUv = ( clearcoatMapTransform * vec3( CLEARCOATMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	vClearcoatNormalMapUv = ( clearcoatNormalMapTransform * vec3( CLEARCOAT_NORMALMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	vClearcoatRoughnessMapUv = ( clearcoatRoughnessMapTransform * vec3( CLEARCOAT_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_IRIDESCENCEMAP
	vIridescenceMapUv = ( iridescenceMapTransform * vec3( IRIDESCENCEMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	vIridescenceThicknessMapUv = ( iridescenceThicknessMapTransform * vec3( IRIDESCENCE_THICKNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SHEEN_COLORMAP
	vSheenColorMapUv = ( sheenColorMapTransform * vec3( SHEEN_COLORMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	vSheenRoughnessMapUv = ( sheenRoughnessMapTransform * vec3( SHEEN_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULARMAP
	vSpecularMapUv = ( specularMapTransform * vec3( SPECULARMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULAR_COLORMAP
	vSpecularColorMapUv = ( specularColorMapTransform * vec3( SPECULAR_COLORMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	vSpecularIntensityMapUv = ( specularIntensityMapTransform * vec3( SPECULAR_INTENSITYMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_TRANSMISSIONMAP
	vTransmissionMapUv = ( transmissionMapTransform * vec3( TRANSMISSIONMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_THICKNESSMAP
	vThicknessMapUv = ( thicknessMapTransform * vec3( THICKNESSMAP_UV, 1 ) ).xy;
#endif`,s_=`#if defined( USE_ENVMAP ) || defined( DISTANCE ) || defined ( USE_SHADOWMAP ) || defined ( USE_TRANSMISSION ) || NUM_SPOT_LIGHT_COORDS > 0
	vec4 worldPosition = vec4( transformed, 1.0 );
	#ifdef USE_BATCHING
		worldPosition = batchingMatrix * worldPosition;
	#endif
	#ifdef USE_INSTANCING
		worldPosition = instanceMatrix * worldPosition;
	#endif
	worldPosition = modelMatrix * worldPosition;
#endif`,r_=`varying vec2 vUv;
uniform mat3 uvTransform;
void main() {
	vUv = ( uvTransform * vec3( uv, 1 ) ).xy;
	gl_Position = vec4( position.xy, 1.0, 1.0 );
}`,o_=`uniform sampler2D t2D;
uniform float backgroundIntensity;
varying vec2 vUv;
void main() {
	vec4 texColor = texture2D( t2D, vUv );
	#ifdef DECODE_VIDEO_TEXTURE
		texColor = vec4( mix( pow( texColor.rgb * 0.9478672986 + vec3( 0.0521327014 ), vec3( 2.4 ) ), texColor.rgb * 0.0773993808, vec3( lessThanEqual( texColor.rgb, vec3( 0.04045 ) ) ) ), texColor.w );
	#endif
	texColor.rgb *= backgroundIntensity;
	gl_FragColor = texColor;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,a_=`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
	gl_Position.z = gl_Position.w;
}`,l_=`uniform float backgroundBlurriness;
uniform float backgroundIntensity;
uniform mat3 backgroundRotation;
varying vec3 vWorldDirection;
#include <envmap_common_pars_fragment>
void main() {
	#ifdef ENVMAP_TYPE_PMREM
		vec4 texColor = textureLod( envMap, backgroundRotation * vWorldDirection, roughnessToMip( backgroundBlurriness ) );
	#else
		vec4 texColor = textureCube( envMap, backgroundRotation * vWorldDirection );
	#endif
	texColor.rgb *= backgroundIntensity;
	gl_FragColor = texColor;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,c_=`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
	gl_Position.z = gl_Position.w;
}`,u_=`uniform samplerCube tCube;
uniform float tFlip;
uniform float opacity;
varying vec3 vWorldDirection;
void main() {
	vec4 texColor = textureCube( tCube, vec3( tFlip * vWorldDirection.x, vWorldDirection.yz ) );
	gl_FragColor = texColor;
	gl_FragColor.a *= opacity;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,h_=`#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
varying vec2 vHighPrecisionZW;
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <skinbase_vertex>
	#include <morphinstance_vertex>
	#ifdef USE_DISPLACEMENTMAP
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vHighPrecisionZW = gl_Position.zw;
}`,f_=`#if DEPTH_PACKING == 3200
	uniform float opacity;
#endif
#include <common>
#include <packing>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
varying vec2 vHighPrecisionZW;
void main() {
	vec4 diffuseColor = vec4( 1.0 );
	#include <clipping_planes_fragment>
	#if DEPTH_PACKING == 3200
		diffuseColor.a = opacity;
	#endif
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <logdepthbuf_fragment>
	#ifdef USE_REVERSED_DEPTH_BUFFER
		float fragCoordZ = vHighPrecisionZW[ 0 ] / vHighPrecisionZW[ 1 ];
	#else
		float fragCoordZ = 0.5 * vHighPrecisionZW[ 0 ] / vHighPrecisionZW[ 1 ] + 0.5;
	#endif
	#if DEPTH_PACKING == 3200
		gl_FragColor = vec4( vec3( 1.0 - fragCoordZ ), opacity );
	#elif DEPTH_PACKING == 3201
		gl_FragColor = packDepthToRGBA( fragCoordZ );
	#elif DEPTH_PACKING == 3202
		gl_FragColor = vec4( packDepthToRGB( fragCoordZ ), 1.0 );
	#elif DEPTH_PACKING == 3203
		gl_FragColor = vec4( packDepthToRG( fragCoordZ ), 0.0, 1.0 );
	#endif
}`,d_=`#define DISTANCE
varying vec3 vWorldPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <skinbase_vertex>
	#include <morphinstance_vertex>
	#ifdef USE_DISPLACEMENTMAP
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <worldpos_vertex>
	#include <clipping_planes_vertex>
	vWorldPosition = worldPosition.xyz;
}`,p_=`#define DISTANCE
uniform vec3 referencePosition;
uniform float nearDistance;
uniform float farDistance;
varying vec3 vWorldPosition;
#include <common>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( 1.0 );
	#include <clipping_planes_fragment>
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	float dist = length( vWorldPosition - referencePosition );
	dist = ( dist - nearDistance ) / ( farDistance - nearDistance );
	dist = saturate( dist );
	gl_FragColor = vec4( dist, 0.0, 0.0, 1.0 );
}`,m_=`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
}`,g_=`uniform sampler2D tEquirect;
varying vec3 vWorldDirection;
#include <common>
void main() {
	vec3 direction = normalize( vWorldDirection );
	vec2 sampleUV = equirectUv( direction );
	gl_FragColor = texture2D( tEquirect, sampleUV );
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,x_=`uniform float scale;
attribute float lineDistance;
varying float vLineDistance;
#include <common>
#include <uv_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	vLineDistance = scale * lineDistance;
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
}`,__=`uniform vec3 diffuse;
uniform float opacity;
uniform float dashSize;
uniform float totalSize;
varying float vLineDistance;
#include <common>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	if ( mod( vLineDistance, totalSize ) > dashSize ) {
		discard;
	}
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,y_=`#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#if defined ( USE_ENVMAP ) || defined ( USE_SKINNING )
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinbase_vertex>
		#include <skinnormal_vertex>
		#include <defaultnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <fog_vertex>
}`,v_=`uniform vec3 diffuse;
uniform float opacity;
#ifndef FLAT_SHADED
	varying vec3 vNormal;
#endif
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <fog_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	#ifdef USE_LIGHTMAP
		vec4 lightMapTexel = texture2D( lightMap, vLightMapUv );
		reflectedLight.indirectDiffuse += lightMapTexel.rgb * lightMapIntensity * RECIPROCAL_PI;
	#else
		reflectedLight.indirectDiffuse += vec3( 1.0 );
	#endif
	#include <aomap_fragment>
	reflectedLight.indirectDiffuse *= diffuseColor.rgb;
	vec3 outgoingLight = reflectedLight.indirectDiffuse;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,M_=`#define LAMBERT
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,S_=`#define LAMBERT
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_lambert_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_lambert_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + totalEmissiveRadiance;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,b_=`#define MATCAP
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <color_pars_vertex>
#include <displacementmap_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
	vViewPosition = - mvPosition.xyz;
}`,w_=`#define MATCAP
uniform vec3 diffuse;
uniform float opacity;
uniform sampler2D matcap;
varying vec3 vViewPosition;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <normal_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	vec3 viewDir = normalize( vViewPosition );
	vec3 x = normalize( vec3( viewDir.z, 0.0, - viewDir.x ) );
	vec3 y = cross( viewDir, x );
	vec2 uv = vec2( dot( x, normal ), dot( y, normal ) ) * 0.495 + 0.5;
	#ifdef USE_MATCAP
		vec4 matcapColor = texture2D( matcap, uv );
	#else
		vec4 matcapColor = vec4( vec3( mix( 0.2, 0.8, uv.y ) ), 1.0 );
	#endif
	vec3 outgoingLight = diffuseColor.rgb * matcapColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,A_=`#define NORMAL
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	varying vec3 vViewPosition;
#endif
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	vViewPosition = - mvPosition.xyz;
#endif
}`,T_=`#define NORMAL
uniform float opacity;
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	varying vec3 vViewPosition;
#endif
#include <uv_pars_fragment>
#include <normal_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( 0.0, 0.0, 0.0, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	gl_FragColor = vec4( normalize( normal ) * 0.5 + 0.5, diffuseColor.a );
	#ifdef OPAQUE
		gl_FragColor.a = 1.0;
	#endif
}`,E_=`#define PHONG
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,R_=`#define PHONG
uniform vec3 diffuse;
uniform vec3 emissive;
uniform vec3 specular;
uniform float shininess;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_phong_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_phong_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + reflectedLight.directSpecular + reflectedLight.indirectSpecular + totalEmissiveRadiance;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,C_=`#define STANDARD
varying vec3 vViewPosition;
#ifdef USE_TRANSMISSION
	varying vec3 vWorldPosition;
#endif
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
#ifdef USE_TRANSMISSION
	vWorldPosition = worldPosition.xyz;
#endif
}`,P_=`#define STANDARD
#ifdef PHYSICAL
	#define IOR
	#define USE_SPECULAR
#endif
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float roughness;
uniform float metalness;
uniform float opacity;
#ifdef IOR
	uniform float ior;
#endif
#ifdef USE_SPECULAR
	uniform float specularIntensity;
	uniform vec3 specularColor;
	#ifdef USE_SPECULAR_COLORMAP
		uniform sampler2D specularColorMap;
	#endif
	#ifdef USE_SPECULAR_INTENSITYMAP
		uniform sampler2D specularIntensityMap;
	#endif
#endif
#ifdef USE_CLEARCOAT
	uniform float clearcoat;
	uniform float clearcoatRoughness;
#endif
#ifdef USE_DIFFUSE_ROUGHNESS
	uniform float diffuseRoughness;
	#ifdef USE_DIFFUSE_ROUGHNESSMAP
		uniform sampler2D diffuseRoughnessMap;
	#endif
#endif
#ifdef USE_DISPERSION
	uniform float dispersion;
#endif
#ifdef USE_RETROREFLECTION
	uniform float retroreflectivity;
#endif
#ifdef USE_IRIDESCENCE
	uniform float iridescence;
	uniform float iridescenceIOR;
	uniform float iridescenceThicknessMinimum;
	uniform float iridescenceThicknessMaximum;
#endif
#ifdef USE_SHEEN
	uniform vec3 sheenColor;
	uniform float sheenRoughness;
	#ifdef USE_SHEEN_COLORMAP
		uniform sampler2D sheenColorMap;
	#endif
	#ifdef USE_SHEEN_ROUGHNESSMAP
		uniform sampler2D sheenRoughnessMap;
	#endif
#endif
#ifdef USE_ANISOTROPY
	uniform vec2 anisotropyVector;
	#ifdef USE_ANISOTROPYMAP
		uniform sampler2D anisotropyMap;
	#endif
#endif
varying vec3 vViewPosition;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <iridescence_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_physical_pars_fragment>
#include <transmission_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <clearcoat_pars_fragment>
#include <iridescence_pars_fragment>
#include <roughnessmap_pars_fragment>
#include <metalnessmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <roughnessmap_fragment>
	#include <metalnessmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <clearcoat_normal_fragment_begin>
	#include <clearcoat_normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_physical_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 totalDiffuse = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse;
	vec3 totalSpecular = reflectedLight.directSpecular + reflectedLight.indirectSpecular;
	#include <transmission_fragment>
	vec3 outgoingLight = totalDiffuse + totalSpecular + totalEmissiveRadiance;
	#ifdef USE_SHEEN
 
		outgoingLight = outgoingLight + sheenSpecularDirect + sheenSpecularIndirect;
 
 	#endif
	#ifdef USE_CLEARCOAT
		float dotNVcc = saturate( dot( geometryClearcoatNormal, geometryViewDir ) );
		vec3 Fcc = F_Schlick( material.clearcoatF0, material.clearcoatF90, dotNVcc );
		outgoingLight = outgoingLight * ( 1.0 - material.clearcoat * Fcc ) + ( clearcoatSpecularDirect + clearcoatSpecularIndirect ) * material.clearcoat;
	#endif
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,I_=`#define TOON
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,L_=`#define TOON
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <gradientmap_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_toon_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_toon_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + totalEmissiveRadiance;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,N_=`uniform float size;
uniform float scale;
#include <common>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
#ifdef USE_POINTS_UV
	varying vec2 vUv;
	uniform mat3 uvTransform;
#endif
void main() {
	#ifdef USE_POINTS_UV
		vUv = ( uvTransform * vec3( uv, 1 ) ).xy;
	#endif
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <project_vertex>
	gl_PointSize = size;
	#ifdef USE_SIZEATTENUATION
		bool isPerspective = isPerspectiveMatrix( projectionMatrix );
		if ( isPerspective ) gl_PointSize *= ( scale / - mvPosition.z );
	#endif
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <worldpos_vertex>
	#include <fog_vertex>
}`,D_=`uniform vec3 diffuse;
uniform float opacity;
#include <common>
#include <color_pars_fragment>
#include <map_particle_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_particle_fragment>
	#include <color_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,U_=`#include <common>
#include <batching_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <shadowmap_pars_vertex>
void main() {
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,F_=`uniform vec3 color;
uniform float opacity;
#include <common>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <logdepthbuf_pars_fragment>
#include <shadowmap_pars_fragment>
#include <shadowmask_pars_fragment>
void main() {
	#include <logdepthbuf_fragment>
	gl_FragColor = vec4( color, opacity * ( 1.0 - getShadowMask() ) );
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,O_=`uniform float rotation;
uniform vec2 center;
#include <common>
#include <uv_pars_vertex>
#include <fog_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	vec4 mvPosition = modelViewMatrix[ 3 ];
	vec2 scale = vec2( length( modelMatrix[ 0 ].xyz ), length( modelMatrix[ 1 ].xyz ) );
	#ifndef USE_SIZEATTENUATION
		bool isPerspective = isPerspectiveMatrix( projectionMatrix );
		if ( isPerspective ) scale *= - mvPosition.z;
	#endif
	vec2 alignedPosition = ( position.xy - ( center - vec2( 0.5 ) ) ) * scale;
	vec2 rotatedPosition;
	rotatedPosition.x = cos( rotation ) * alignedPosition.x - sin( rotation ) * alignedPosition.y;
	rotatedPosition.y = sin( rotation ) * alignedPosition.x + cos( rotation ) * alignedPosition.y;
	mvPosition.xy += rotatedPosition;
	gl_Position = projectionMatrix * mvPosition;
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
}`,B_=`uniform vec3 diffuse;
uniform float opacity;
#include <common>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
}`,Gt={alphahash_fragment:o0,alphahash_pars_fragment:a0,alphamap_fragment:l0,alphamap_pars_fragment:c0,alphatest_fragment:u0,alphatest_pars_fragment:h0,aomap_fragment:f0,aomap_pars_fragment:d0,batching_pars_vertex:p0,batching_vertex:m0,begin_vertex:g0,beginnormal_vertex:x0,bsdfs:_0,iridescence_fragment:y0,bumpmap_pars_fragment:v0,clipping_planes_fragment:M0,clipping_planes_pars_fragment:S0,clipping_planes_pars_vertex:b0,clipping_planes_vertex:w0,color_fragment:A0,color_pars_fragment:T0,color_pars_vertex:E0,color_vertex:R0,common:C0,defaultnormal_vertex:P0,displacementmap_pars_vertex:I0,displacementmap_vertex:L0,emissivemap_fragment:N0,emissivemap_pars_fragment:D0,colorspace_fragment:U0,colorspace_pars_fragment:F0,envmap_fragment:O0,envmap_common_pars_fragment:B0,envmap_pars_fragment:z0,envmap_pars_vertex:k0,envmap_physical_pars_fragment:K0,envmap_vertex:V0,fog_vertex:G0,fog_pars_vertex:H0,fog_fragment:W0,fog_pars_fragment:X0,gradientmap_pars_fragment:q0,lightmap_pars_fragment:Y0,lights_lambert_fragment:$0,lights_lambert_pars_fragment:Z0,lights_pars_begin:J0,lights_toon_fragment:Q0,lights_toon_pars_fragment:j0,lights_phong_fragment:tx,lights_phong_pars_fragment:ex,lights_physical_fragment:nx,lights_physical_pars_fragment:ix,lights_fragment_begin:sx,lights_fragment_maps:rx,lights_fragment_end:ox,lightprobes_pars_fragment:ax,logdepthbuf_fragment:lx,logdepthbuf_pars_fragment:cx,logdepthbuf_pars_vertex:ux,logdepthbuf_vertex:hx,map_fragment:fx,map_pars_fragment:dx,map_particle_fragment:px,map_particle_pars_fragment:mx,metalnessmap_fragment:gx,metalnessmap_pars_fragment:xx,morphinstance_vertex:_x,morphcolor_vertex:yx,morphnormal_vertex:vx,morphtarget_pars_vertex:Mx,morphtarget_vertex:Sx,normal_fragment_begin:bx,normal_fragment_maps:wx,normal_pars_fragment:Ax,normal_pars_vertex:Tx,normal_vertex:Ex,normalmap_pars_fragment:Rx,clearcoat_normal_fragment_begin:Cx,clearcoat_normal_fragment_maps:Px,clearcoat_pars_fragment:Ix,iridescence_pars_fragment:Lx,opaque_fragment:Nx,packing:Dx,premultiplied_alpha_fragment:Ux,project_vertex:Fx,dithering_fragment:Ox,dithering_pars_fragment:Bx,roughnessmap_fragment:zx,roughnessmap_pars_fragment:kx,shadowmap_pars_fragment:Vx,shadowmap_pars_vertex:Gx,shadowmap_vertex:Hx,shadowmask_pars_fragment:Wx,skinbase_vertex:Xx,skinning_pars_vertex:qx,skinning_vertex:Yx,skinnormal_vertex:$x,specularmap_fragment:Zx,specularmap_pars_fragment:Jx,tonemapping_fragment:Kx,tonemapping_pars_fragment:Qx,transmission_fragment:jx,transmission_pars_fragment:t_,uv_pars_fragment:e_,uv_pars_vertex:n_,uv_vertex:i_,worldpos_vertex:s_,background_vert:r_,background_frag:o_,backgroundCube_vert:a_,backgroundCube_frag:l_,cube_vert:c_,cube_frag:u_,depth_vert:h_,depth_frag:f_,distance_vert:d_,distance_frag:p_,equirect_vert:m_,equirect_frag:g_,linedashed_vert:x_,linedashed_frag:__,meshbasic_vert:y_,meshbasic_frag:v_,meshlambert_vert:M_,meshlambert_frag:S_,meshmatcap_vert:b_,meshmatcap_frag:w_,meshnormal_vert:A_,meshnormal_frag:T_,meshphong_vert:E_,meshphong_frag:R_,meshphysical_vert:C_,meshphysical_frag:P_,meshtoon_vert:I_,meshtoon_frag:L_,points_vert:N_,points_frag:D_,shadow_vert:U_,shadow_frag:F_,sprite_vert:O_,sprite_frag:B_},gt={common:{diffuse:{value:new Zt(16777215)},opacity:{value:1},map:{value:null},mapTransform:{value:new Dt},alphaMap:{value:null},alphaMapTransform:{value:new Dt},alphaTest:{value:0}},specularmap:{specularMap:{value:null},specularMapTransform:{value:new Dt}},envmap:{envMap:{value:null},envMapRotation:{value:new Dt},reflectivity:{value:1},ior:{value:1.5},refractionRatio:{value:.98},dfgLUT:{value:null}},aomap:{aoMap:{value:null},aoMapIntensity:{value:1},aoMapTransform:{value:new Dt}},lightmap:{lightMap:{value:null},lightMapIntensity:{value:1},lightMapTransform:{value:new Dt}},bumpmap:{bumpMap:{value:null},bumpMapTransform:{value:new Dt},bumpScale:{value:1}},normalmap:{normalMap:{value:null},normalMapTransform:{value:new Dt},normalScale:{value:new Et(1,1)}},displacementmap:{displacementMap:{value:null},displacementMapTransform:{value:new Dt},displacementScale:{value:1},displacementBias:{value:0}},emissivemap:{emissiveMap:{value:null},emissiveMapTransform:{value:new Dt}},metalnessmap:{metalnessMap:{value:null},metalnessMapTransform:{value:new Dt}},roughnessmap:{roughnessMap:{value:null},roughnessMapTransform:{value:new Dt}},gradientmap:{gradientMap:{value:null}},fog:{fogDensity:{value:25e-5},fogNear:{value:1},fogFar:{value:2e3},fogColor:{value:new Zt(16777215)}},lights:{ambientLightColor:{value:[]},lightProbe:{value:[]},sunLights:{value:[],properties:{direction:{},color:{}}},sunLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},sunShadowMatrix:{value:[]},sunShadowCascade:{value:[]},directionalLights:{value:[],properties:{direction:{},color:{}}},directionalLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},directionalShadowMatrix:{value:[]},spotLights:{value:[],properties:{color:{},position:{},direction:{},distance:{},coneCos:{},penumbraCos:{},decay:{}}},spotLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},spotLightMap:{value:[]},spotLightMatrix:{value:[]},pointLights:{value:[],properties:{color:{},position:{},decay:{},distance:{}}},pointLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{},shadowCameraNear:{},shadowCameraFar:{}}},pointShadowMatrix:{value:[]},hemisphereLights:{value:[],properties:{direction:{},skyColor:{},groundColor:{}}},rectAreaLights:{value:[],properties:{color:{},position:{},width:{},height:{}}},ltc_1:{value:null},ltc_2:{value:null},probesSH:{value:[]},probesMin:{value:[]},probesMax:{value:[]},probesResolution:{value:[]}},points:{diffuse:{value:new Zt(16777215)},opacity:{value:1},size:{value:1},scale:{value:1},map:{value:null},alphaMap:{value:null},alphaMapTransform:{value:new Dt},alphaTest:{value:0},uvTransform:{value:new Dt}},sprite:{diffuse:{value:new Zt(16777215)},opacity:{value:1},center:{value:new Et(.5,.5)},rotation:{value:0},map:{value:null},mapTransform:{value:new Dt},alphaMap:{value:null},alphaMapTransform:{value:new Dt},alphaTest:{value:0}}},ti={basic:{uniforms:tn([gt.common,gt.specularmap,gt.envmap,gt.aomap,gt.lightmap,gt.fog]),vertexShader:Gt.meshbasic_vert,fragmentShader:Gt.meshbasic_frag},lambert:{uniforms:tn([gt.common,gt.specularmap,gt.envmap,gt.aomap,gt.lightmap,gt.emissivemap,gt.bumpmap,gt.normalmap,gt.displacementmap,gt.fog,gt.lights,{emissive:{value:new Zt(0)},envMapIntensity:{value:1}}]),vertexShader:Gt.meshlambert_vert,fragmentShader:Gt.meshlambert_frag},phong:{uniforms:tn([gt.common,gt.specularmap,gt.envmap,gt.aomap,gt.lightmap,gt.emissivemap,gt.bumpmap,gt.normalmap,gt.displacementmap,gt.fog,gt.lights,{emissive:{value:new Zt(0)},specular:{value:new Zt(1118481)},shininess:{value:30},envMapIntensity:{value:1}}]),vertexShader:Gt.meshphong_vert,fragmentShader:Gt.meshphong_frag},standard:{uniforms:tn([gt.common,gt.envmap,gt.aomap,gt.lightmap,gt.emissivemap,gt.bumpmap,gt.normalmap,gt.displacementmap,gt.roughnessmap,gt.metalnessmap,gt.fog,gt.lights,{emissive:{value:new Zt(0)},roughness:{value:1},metalness:{value:0},envMapIntensity:{value:1}}]),vertexShader:Gt.meshphysical_vert,fragmentShader:Gt.meshphysical_frag},toon:{uniforms:tn([gt.common,gt.aomap,gt.lightmap,gt.emissivemap,gt.bumpmap,gt.normalmap,gt.displacementmap,gt.gradientmap,gt.fog,gt.lights,{emissive:{value:new Zt(0)}}]),vertexShader:Gt.meshtoon_vert,fragmentShader:Gt.meshtoon_frag},matcap:{uniforms:tn([gt.common,gt.bumpmap,gt.normalmap,gt.displacementmap,gt.fog,{matcap:{value:null}}]),vertexShader:Gt.meshmatcap_vert,fragmentShader:Gt.meshmatcap_frag},points:{uniforms:tn([gt.points,gt.fog]),vertexShader:Gt.points_vert,fragmentShader:Gt.points_frag},dashed:{uniforms:tn([gt.common,gt.fog,{scale:{value:1},dashSize:{value:1},totalSize:{value:2}}]),vertexShader:Gt.linedashed_vert,fragmentShader:Gt.linedashed_frag},depth:{uniforms:tn([gt.common,gt.displacementmap]),vertexShader:Gt.depth_vert,fragmentShader:Gt.depth_frag},normal:{uniforms:tn([gt.common,gt.bumpmap,gt.normalmap,gt.displacementmap,{opacity:{value:1}}]),vertexShader:Gt.meshnormal_vert,fragmentShader:Gt.meshnormal_frag},sprite:{uniforms:tn([gt.sprite,gt.fog]),vertexShader:Gt.sprite_vert,fragmentShader:Gt.sprite_frag},background:{uniforms:{uvTransform:{value:new Dt},t2D:{value:null},backgroundIntensity:{value:1}},vertexShader:Gt.background_vert,fragmentShader:Gt.background_frag},backgroundCube:{uniforms:{envMap:{value:null},backgroundBlurriness:{value:0},backgroundIntensity:{value:1},backgroundRotation:{value:new Dt}},vertexShader:Gt.backgroundCube_vert,fragmentShader:Gt.backgroundCube_frag},cube:{uniforms:{tCube:{value:null},tFlip:{value:-1},opacity:{value:1}},vertexShader:Gt.cube_vert,fragmentShader:Gt.cube_frag},equirect:{uniforms:{tEquirect:{value:null}},vertexShader:Gt.equirect_vert,fragmentShader:Gt.equirect_frag},distance:{uniforms:tn([gt.common,gt.displacementmap,{referencePosition:{value:new N},nearDistance:{value:1},farDistance:{value:1e3}}]),vertexShader:Gt.distance_vert,fragmentShader:Gt.distance_frag},shadow:{uniforms:tn([gt.lights,gt.fog,{color:{value:new Zt(0)},opacity:{value:1}}]),vertexShader:Gt.shadow_vert,fragmentShader:Gt.shadow_frag}};ti.physical={uniforms:tn([ti.standard.uniforms,{clearcoat:{value:0},clearcoatMap:{value:null},clearcoatMapTransform:{value:new Dt},clearcoatNormalMap:{value:null},clearcoatNormalMapTransform:{value:new Dt},clearcoatNormalScale:{value:new Et(1,1)},clearcoatRoughness:{value:0},clearcoatRoughnessMap:{value:null},clearcoatRoughnessMapTransform:{value:new Dt},diffuseRoughness:{value:0},diffuseRoughnessMap:{value:null},diffuseRoughnessMapTransform:{value:new Dt},dispersion:{value:0},retroreflectivity:{value:0},iridescence:{value:0},iridescenceMap:{value:null},iridescenceMapTransform:{value:new Dt},iridescenceIOR:{value:1.3},iridescenceThicknessMinimum:{value:100},iridescenceThicknessMaximum:{value:400},iridescenceThicknessMap:{value:null},iridescenceThicknessMapTransform:{value:new Dt},sheen:{value:0},sheenColor:{value:new Zt(0)},sheenColorMap:{value:null},sheenColorMapTransform:{value:new Dt},sheenRoughness:{value:1},sheenRoughnessMap:{value:null},sheenRoughnessMapTransform:{value:new Dt},transmission:{value:0},transmissionMap:{value:null},transmissionMapTransform:{value:new Dt},transmissionSamplerSize:{value:new Et},transmissionSamplerMap:{value:null},thickness:{value:0},thicknessMap:{value:null},thicknessMapTransform:{value:new Dt},attenuationDistance:{value:0},attenuationColor:{value:new Zt(0)},specularColor:{value:new Zt(1,1,1)},specularColorMap:{value:null},specularColorMapTransform:{value:new Dt},specularIntensity:{value:1},specularIntensityMap:{value:null},specularIntensityMapTransform:{value:new Dt},anisotropyVector:{value:new Et},anisotropyMap:{value:null},anisotropyMapTransform:{value:new Dt}}]),vertexShader:Gt.meshphysical_vert,fragmentShader:Gt.meshphysical_frag};var Tl={r:0,b:0,g:0},z_=new zt,hp=new Dt;hp.set(-1,0,0,0,1,0,0,0,1);function k_(i,t,e,n,s,r){let o=new Zt(0),l=s===!0?0:1,a,c,u=null,h=0,f=null;function d(x){let M=x.isScene===!0?x.background:null;if(M&&M.isTexture){let v=x.backgroundBlurriness>0;M=t.get(M,v)}return M}function g(x){let M=!1,v=d(x);v===null?p(o,l):v&&v.isColor&&(p(v,1),M=!0);let S=i.xr.getEnvironmentBlendMode();S==="additive"?e.buffers.color.setClear(0,0,0,1,r):S==="alpha-blend"&&e.buffers.color.setClear(0,0,0,0,r),(i.autoClear||M)&&(e.buffers.depth.setTest(!0),e.buffers.depth.setMask(!0),e.buffers.color.setMask(!0),i.clear(i.autoClearColor,i.autoClearDepth,i.autoClearStencil))}function y(x,M){let v=d(M);v&&v.isCubeTexture?(c===void 0&&(c=new de(new Ys(1,1,1),new je({name:"BackgroundCubeMaterial",uniforms:ms(ti.backgroundCube.uniforms),vertexShader:ti.backgroundCube.vertexShader,fragmentShader:ti.backgroundCube.fragmentShader,side:qe,depthTest:!1,depthWrite:!1,fog:!1,allowOverride:!1})),c.geometry.deleteAttribute("normal"),c.geometry.deleteAttribute("uv"),c.onBeforeRender=function(S,A,_){this.matrixWorld.copyPosition(_.matrixWorld)},Object.defineProperty(c.material,"envMap",{get:function(){return this.uniforms.envMap.value}}),n.update(c)),c.material.uniforms.envMap.value=v,c.material.uniforms.backgroundBlurriness.value=M.backgroundBlurriness,c.material.uniforms.backgroundIntensity.value=M.backgroundIntensity,c.material.uniforms.backgroundRotation.value.setFromMatrix4(z_.makeRotationFromEuler(M.backgroundRotation)).transpose(),v.isRenderTargetTexture===!1&&c.material.uniforms.backgroundRotation.value.premultiply(hp),c.material.toneMapped=Yt.getTransfer(v.colorSpace)!==ne,(u!==v||h!==v.version||f!==i.toneMapping)&&(c.material.needsUpdate=!0,u=v,h=v.version,f=i.toneMapping),c.layers.enableAll(),x.unshift(c,c.geometry,c.material,0,0,null)):v&&v.isTexture&&(a===void 0&&(a=new de(new yi(2,2),new je({name:"BackgroundMaterial",uniforms:ms(ti.background.uniforms),vertexShader:ti.background.vertexShader,fragmentShader:ti.background.fragmentShader,side:Vn,depthTest:!1,depthWrite:!1,fog:!1,allowOverride:!1})),a.geometry.deleteAttribute("normal"),Object.defineProperty(a.material,"map",{get:function(){return this.uniforms.t2D.value}}),n.update(a)),a.material.uniforms.t2D.value=v,a.material.uniforms.backgroundIntensity.value=M.backgroundIntensity,a.material.toneMapped=Yt.getTransfer(v.colorSpace)!==ne,v.matrixAutoUpdate===!0&&v.updateMatrix(),a.material.uniforms.uvTransform.value.copy(v.matrix),(u!==v||h!==v.version||f!==i.toneMapping)&&(a.material.needsUpdate=!0,u=v,h=v.version,f=i.toneMapping),a.layers.enableAll(),x.unshift(a,a.geometry,a.material,0,0,null))}function p(x,M){x.getRGB(Tl,Zu(i)),e.buffers.color.setClear(Tl.r,Tl.g,Tl.b,M,r)}function m(){c!==void 0&&(c.geometry.dispose(),c.material.dispose(),c=void 0),a!==void 0&&(a.geometry.dispose(),a.material.dispose(),a=void 0)}return{getClearColor:function(){return o},setClearColor:function(x,M=1){o.set(x),l=M,p(o,l)},getClearAlpha:function(){return l},setClearAlpha:function(x){l=x,p(o,l)},render:g,addToRenderList:y,dispose:m}}function V_(i,t){let e=i.getParameter(i.MAX_VERTEX_ATTRIBS),n={},s=f(null),r=s,o=!1;function l(C,I,U,P,B){let H=!1,G=h(C,P,U,I);r!==G&&(r=G,c(r.object)),H=d(C,P,U,B),H&&g(C,P,U,B),B!==null&&t.update(B,i.ELEMENT_ARRAY_BUFFER),(H||o)&&(o=!1,v(C,I,U,P),B!==null&&i.bindBuffer(i.ELEMENT_ARRAY_BUFFER,t.get(B).buffer))}function a(){return i.createVertexArray()}function c(C){return i.bindVertexArray(C)}function u(C){return i.deleteVertexArray(C)}function h(C,I,U,P){let B=P.wireframe===!0,H=n[I.id];H===void 0&&(H={},n[I.id]=H);let G=C.isInstancedMesh===!0?C.id:0,et=H[G];et===void 0&&(et={},H[G]=et);let X=et[U.id];X===void 0&&(X={},et[U.id]=X);let j=X[B];return j===void 0&&(j=f(a()),X[B]=j),j}function f(C){let I=[],U=[],P=[];for(let B=0;B<e;B++)I[B]=0,U[B]=0,P[B]=0;return{geometry:null,program:null,wireframe:!1,newAttributes:I,enabledAttributes:U,attributeDivisors:P,object:C,attributes:{},index:null}}function d(C,I,U,P){let B=r.attributes,H=I.attributes,G=0,et=U.getAttributes();for(let X in et)if(et[X].location>=0){let tt=B[X],yt=H[X];if(yt===void 0&&(X==="instanceMatrix"&&C.instanceMatrix&&(yt=C.instanceMatrix),X==="instanceColor"&&C.instanceColor&&(yt=C.instanceColor)),tt===void 0||tt.attribute!==yt||yt&&tt.data!==yt.data)return!0;G++}return r.attributesNum!==G||r.index!==P}function g(C,I,U,P){let B={},H=I.attributes,G=0,et=U.getAttributes();for(let X in et)if(et[X].location>=0){let tt=H[X];tt===void 0&&(X==="instanceMatrix"&&C.instanceMatrix&&(tt=C.instanceMatrix),X==="instanceColor"&&C.instanceColor&&(tt=C.instanceColor));let yt={};yt.attribute=tt,tt&&tt.data&&(yt.data=tt.data),B[X]=yt,G++}r.attributes=B,r.attributesNum=G,r.index=P}function y(){let C=r.newAttributes;for(let I=0,U=C.length;I<U;I++)C[I]=0}function p(C){m(C,0)}function m(C,I){let U=r.newAttributes,P=r.enabledAttributes,B=r.attributeDivisors;U[C]=1,P[C]===0&&(i.enableVertexAttribArray(C),P[C]=1),B[C]!==I&&(i.vertexAttribDivisor(C,I),B[C]=I)}function x(){let C=r.newAttributes,I=r.enabledAttributes;for(let U=0,P=I.length;U<P;U++)I[U]!==C[U]&&(i.disableVertexAttribArray(U),I[U]=0)}function M(C,I,U,P,B,H,G){G===!0?i.vertexAttribIPointer(C,I,U,B,H):i.vertexAttribPointer(C,I,U,P,B,H)}function v(C,I,U,P){y();let B=P.attributes,H=U.getAttributes(),G=I.defaultAttributeValues;for(let et in H){let X=H[et];if(X.location>=0){let j=B[et];if(j===void 0&&(et==="instanceMatrix"&&C.instanceMatrix&&(j=C.instanceMatrix),et==="instanceColor"&&C.instanceColor&&(j=C.instanceColor)),j!==void 0){let tt=j.normalized,yt=j.itemSize,Nt=t.get(j);if(Nt===void 0)continue;let J=Nt.buffer,ut=Nt.type,_t=Nt.bytesPerElement,Tt=ut===i.INT||ut===i.UNSIGNED_INT||j.gpuType===Ha;if(j.isInterleavedBufferAttribute){let pt=j.data,Ut=pt.isInterleavedBuffer===!0?pt.stride:pt.itemSize,Se=j.offset;if(pt.isInstancedInterleavedBuffer||pt.isInstancedBufferAttribute){for(let Ct=0;Ct<X.locationSize;Ct++)m(X.location+Ct,pt.meshPerAttribute);C.isInstancedMesh!==!0&&P._maxInstanceCount===void 0&&(P._maxInstanceCount=pt.meshPerAttribute*pt.count)}else for(let Ct=0;Ct<X.locationSize;Ct++)p(X.location+Ct);i.bindBuffer(i.ARRAY_BUFFER,J);for(let Ct=0;Ct<X.locationSize;Ct++)M(X.location+Ct,yt/X.locationSize,ut,tt,Ut*_t,(Se+yt/X.locationSize*Ct)*_t,Tt)}else{if(j.isInstancedBufferAttribute){for(let pt=0;pt<X.locationSize;pt++)m(X.location+pt,j.meshPerAttribute);C.isInstancedMesh!==!0&&P._maxInstanceCount===void 0&&(P._maxInstanceCount=j.meshPerAttribute*j.count)}else for(let pt=0;pt<X.locationSize;pt++)p(X.location+pt);i.bindBuffer(i.ARRAY_BUFFER,J);for(let pt=0;pt<X.locationSize;pt++)M(X.location+pt,yt/X.locationSize,ut,tt,yt*_t,yt/X.locationSize*pt*_t,Tt)}}else if(G!==void 0){let tt=G[et];if(tt!==void 0)switch(tt.length){case 2:i.vertexAttrib2fv(X.location,tt);break;case 3:i.vertexAttrib3fv(X.location,tt);break;case 4:i.vertexAttrib4fv(X.location,tt);break;default:i.vertexAttrib1fv(X.location,tt)}}}}x()}function S(){L();for(let C in n){let I=n[C];for(let U in I){let P=I[U];for(let B in P){let H=P[B];for(let G in H)u(H[G].object),delete H[G];delete P[B]}}delete n[C]}}function A(C){if(n[C.id]===void 0)return;let I=n[C.id];for(let U in I){let P=I[U];for(let B in P){let H=P[B];for(let G in H)u(H[G].object),delete H[G];delete P[B]}}delete n[C.id]}function _(C){for(let I in n){let U=n[I];for(let P in U){let B=U[P];if(B[C.id]===void 0)continue;let H=B[C.id];for(let G in H)u(H[G].object),delete H[G];delete B[C.id]}}}function b(C){for(let I in n){let U=n[I],P=C.isInstancedMesh===!0?C.id:0,B=U[P];if(B!==void 0){for(let H in B){let G=B[H];for(let et in G)u(G[et].object),delete G[et];delete B[H]}delete U[P],Object.keys(U).length===0&&delete n[I]}}}function L(){E(),o=!0,r!==s&&(r=s,c(r.object))}function E(){s.geometry=null,s.program=null,s.wireframe=!1}return{setup:l,reset:L,resetDefaultState:E,dispose:S,releaseStatesOfGeometry:A,releaseStatesOfObject:b,releaseStatesOfProgram:_,initAttributes:y,enableAttribute:p,disableUnusedAttributes:x}}function G_(i,t,e){let n;function s(a){n=a}function r(a,c){i.drawArrays(n,a,c),e.update(c,n,1)}function o(a,c,u){u!==0&&(i.drawArraysInstanced(n,a,c,u),e.update(c,n,u))}function l(a,c,u){if(u===0)return;t.get("WEBGL_multi_draw").multiDrawArraysWEBGL(n,a,0,c,0,u);let f=0;for(let d=0;d<u;d++)f+=c[d];e.update(f,n,1)}this.setMode=s,this.render=r,this.renderInstances=o,this.renderMultiDraw=l}function H_(i,t,e,n){let s;function r(){if(s!==void 0)return s;if(t.has("EXT_texture_filter_anisotropic")===!0){let _=t.get("EXT_texture_filter_anisotropic");s=i.getParameter(_.MAX_TEXTURE_MAX_ANISOTROPY_EXT)}else s=0;return s}function o(_){return!(_!==Mn&&n.convert(_)!==i.getParameter(i.IMPLEMENTATION_COLOR_READ_FORMAT))}function l(_){let b=_===Wn&&(t.has("EXT_color_buffer_half_float")||t.has("EXT_color_buffer_float"));return!(_!==ln&&_!==Hn&&!b&&n.convert(_)!==i.getParameter(i.IMPLEMENTATION_COLOR_READ_TYPE))}function a(_){if(_==="highp"){if(i.getShaderPrecisionFormat(i.VERTEX_SHADER,i.HIGH_FLOAT).precision>0&&i.getShaderPrecisionFormat(i.FRAGMENT_SHADER,i.HIGH_FLOAT).precision>0)return"highp";_="mediump"}return _==="mediump"&&i.getShaderPrecisionFormat(i.VERTEX_SHADER,i.MEDIUM_FLOAT).precision>0&&i.getShaderPrecisionFormat(i.FRAGMENT_SHADER,i.MEDIUM_FLOAT).precision>0?"mediump":"lowp"}let c=e.precision!==void 0?e.precision:"highp",u=a(c);u!==c&&(Rt("WebGLRenderer:",c,"not supported, using",u,"instead."),c=u);let h=e.reversedDepthBuffer===!0&&t.has("EXT_clip_control"),f=e.logarithmicDepthBuffer===!0&&h===!1;e.reversedDepthBuffer===!0&&h===!1&&Rt("WebGLRenderer: Unable to use reversed depth buffer due to missing EXT_clip_control extension. Fallback to default depth buffer."),e.logarithmicDepthBuffer===!0&&h===!0&&Rt("WebGLRenderer: Logarithmic depth buffer is ignored when reversed depth buffer is enabled.");let d=i.getParameter(i.MAX_TEXTURE_IMAGE_UNITS),g=i.getParameter(i.MAX_VERTEX_TEXTURE_IMAGE_UNITS),y=i.getParameter(i.MAX_TEXTURE_SIZE),p=i.getParameter(i.MAX_CUBE_MAP_TEXTURE_SIZE),m=i.getParameter(i.MAX_VERTEX_ATTRIBS),x=i.getParameter(i.MAX_VERTEX_UNIFORM_VECTORS),M=i.getParameter(i.MAX_VARYING_VECTORS),v=i.getParameter(i.MAX_FRAGMENT_UNIFORM_VECTORS),S=i.getParameter(i.MAX_SAMPLES),A=i.getParameter(i.SAMPLES);return{isWebGL2:!0,getMaxAnisotropy:r,getMaxPrecision:a,textureFormatReadable:o,textureTypeReadable:l,precision:c,logarithmicDepthBuffer:f,reversedDepthBuffer:h,maxTextures:d,maxVertexTextures:g,maxTextureSize:y,maxCubemapSize:p,maxAttributes:m,maxVertexUniforms:x,maxVaryings:M,maxFragmentUniforms:v,maxSamples:S,samples:A}}function W_(i){let t=this,e=null,n=0,s=!1,r=!1,o=new sn,l=new Dt,a={value:null,needsUpdate:!1};this.uniform=a,this.numPlanes=0,this.numIntersection=0,this.init=function(h,f){let d=h.length!==0||f||n!==0||s;return s=f,n=h.length,d},this.beginShadows=function(){r=!0,u(null)},this.endShadows=function(){r=!1},this.setGlobalState=function(h,f){e=u(h,f,0)},this.setState=function(h,f,d){let g=h.clippingPlanes,y=h.clipIntersection,p=h.clipShadows,m=i.get(h);if(!s||g===null||g.length===0||r&&!p)r?u(null):c();else{let x=r?0:n,M=x*4,v=m.clippingState||null;a.value=v,v=u(g,f,M,d);for(let S=0;S!==M;++S)v[S]=e[S];m.clippingState=v,this.numIntersection=y?this.numPlanes:0,this.numPlanes+=x}};function c(){a.value!==e&&(a.value=e,a.needsUpdate=n>0),t.numPlanes=n,t.numIntersection=0}function u(h,f,d,g){let y=h!==null?h.length:0,p=null;if(y!==0){if(p=a.value,g!==!0||p===null){let m=d+y*4,x=f.matrixWorldInverse;l.getNormalMatrix(x),(p===null||p.length<m)&&(p=new Float32Array(m));for(let M=0,v=d;M!==y;++M,v+=4)o.copy(h[M]).applyMatrix4(x,l),o.normal.toArray(p,v),p[v+3]=o.constant}a.value=p,a.needsUpdate=!0}return t.numPlanes=y,t.numIntersection=0,p}}var oo=class extends on{constructor(t=1,e={}){super(t,t,e),this.isWebGLCubeRenderTarget=!0;let n={width:t,height:t,depth:1},s=[n,n,n,n,n,n];this.texture=new Vr(s),this._setTextureOptions(e),this.texture.isRenderTargetTexture=!0}fromEquirectangularTexture(t,e){this.texture.type=e.type,this.texture.colorSpace=e.colorSpace,this.texture.generateMipmaps=e.generateMipmaps,this.texture.minFilter=e.minFilter,this.texture.magFilter=e.magFilter;let n={uniforms:{tEquirect:{value:null}},vertexShader:`

				varying vec3 vWorldDirection;

				vec3 transformDirection( in vec3 dir, in mat4 matrix ) {

					return normalize( ( matrix * vec4( dir, 0.0 ) ).xyz );

				}

				void main() {

					vWorldDirection = transformDirection( position, modelMatrix );

					#include <begin_vertex>
					#include <project_vertex>

				}
			`,fragmentShader:`

				uniform sampler2D tEquirect;

				varying vec3 vWorldDirection;

				#include <common>

				void main() {

					vec3 direction = normalize( vWorldDirection );

					vec2 sampleUV = equirectUv( direction );

					gl_FragColor = texture2D( tEquirect, sampleUV );

				}
			`},s=new Ys(5,5,5),r=new je({name:"CubemapFromEquirect",uniforms:ms(n.uniforms),vertexShader:n.vertexShader,fragmentShader:n.fragmentShader,side:qe,blending:hs});r.uniforms.tEquirect.value=e;let o=new de(s,r),l=e.minFilter;return e.minFilter===vi&&(e.minFilter=rn),new $s(1,10,this).update(t,o),e.minFilter=l,o.geometry.dispose(),o.material.dispose(),this}clear(t,e=!0,n=!0,s=!0){let r=t.getRenderTarget();for(let o=0;o<6;o++)t.setRenderTarget(this,o),t.clear(e,n,s);t.setRenderTarget(r)}},Hd=256,X_=3,q_=20,fp=256,dp=16,Y_=3,$_=new N,Z_=new Zt,Rl=class i{constructor(t){this._renderer=t,this._cubeSize=0,this._sourceTarget=null,this._cubeCamera=new $s(1,10,null),this._boxMesh=new de(new Ys(5,5,5),null),this._cubemapMaterial=null,this._equirectMaterial=null,this._blurMaterial=null,this._ggxMaterial=null,this._integrationMaterial=null}fromScene(t,e=0,n=.1,s=100,r={}){let{size:o=256,position:l=$_}=r,a=this._renderer;this._setSize(o);let c=this._allocateTarget(),u=this._getSourceTarget(!0);e>0&&(u.texture.mipmapsAutoUpdate=!1);let h=a.autoClear,f=a.autoClearColor,d=a.autoClearDepth,g=a.autoClearStencil,y=t.background;a.autoClear=!0,a.autoClearColor=!0,a.autoClearDepth=!0,a.autoClearStencil=!0,y===null&&(t.background=a.getClearColor(Z_));let p=new $s(n,s,u);return p.position.copy(l),p.update(a,t),a.autoClear=h,a.autoClearColor=f,a.autoClearDepth=d,a.autoClearStencil=g,t.background=y,e>0&&(u.texture.mipmapsAutoUpdate=!0,this._blur(c,e)),this._applyPMREM(c),c}fromEquirectangular(t,e=null){return this._fromTexture(t,e)}fromCubemap(t,e=null){return this._fromTexture(t,e)}compileCubemapShader(){this._cubemapMaterial===null&&(this._cubemapMaterial=qd(),this._compileMaterial(this._cubemapMaterial))}compileEquirectangularShader(){this._equirectMaterial===null&&(this._equirectMaterial=Xd(),this._compileMaterial(this._equirectMaterial))}dispose(){this._sourceTarget!==null&&this._sourceTarget.dispose(),this._cubemapMaterial!==null&&this._cubemapMaterial.dispose(),this._equirectMaterial!==null&&this._equirectMaterial.dispose(),this._blurMaterial!==null&&this._blurMaterial.dispose(),this._ggxMaterial!==null&&this._ggxMaterial.dispose(),this._integrationMaterial!==null&&this._integrationMaterial.dispose(),this._boxMesh.geometry.dispose()}static lodToRoughness(t,e){return e>0?1-Math.sqrt(1-t/e):0}_setSize(t){this._cubeSize=Math.max(Hd,Bd(t))}_fromTexture(t,e){t.mapping===ds||t.mapping===Ks?this._setSize(t.image.length===0?Hd:t.image[0].width||t.image[0].image.width):this._setSize(t.image.width/4);let n=e||this._allocateTarget();return this._textureToCubemap(t),this._applyPMREM(n),n}_allocateTarget(){let t=this._cubeSize,e=Wd(t,!1,!1),n=Math.log2(t)-X_;for(let s=0;s<=n;s++)e.texture.mipmaps.push({width:t>>s,height:t>>s});return e.texture.name="PMREM",e.texture.isPMREMTexture=!0,e}_getSourceTarget(t=!1){let e=this._cubeSize,n=this._sourceTarget;return(n===null||n.width!==e||t&&n.depthBuffer===!1)&&(n!==null&&n.dispose(),this._sourceTarget=Wd(e,!0,t)),this._sourceTarget}_compileMaterial(t){this._boxMesh.material=t,this._renderer.compile(this._boxMesh,this._cubeCamera.children[0])}_renderCube(t,e,n){let s=this._boxMesh,r=this._cubeCamera;s.material=n,r.renderTarget=t,r.activeMipmapLevel=e;let o=t.width>>e;t.viewport.set(0,0,o,o),r.update(this._renderer,s),t.viewport.set(0,0,t.width,t.height)}_textureToCubemap(t){let e;t.mapping===ds||t.mapping===Ks?(this._cubemapMaterial===null&&(this._cubemapMaterial=qd()),e=this._cubemapMaterial,e.uniforms.flipEnvMap.value=t.isRenderTargetTexture===!1?-1:1):(this._equirectMaterial===null&&(this._equirectMaterial=Xd()),e=this._equirectMaterial),e.uniforms.envMap.value=t,this._renderCube(this._getSourceTarget(),0,e)}_applyPMREM(t){this._ggxMaterial===null&&(this._ggxMaterial=J_(),this._integrationMaterial=K_());let e=this._cubeSize,n=t.texture.mipmaps.length-1,s=this._ggxMaterial.uniforms;s.envMap.value=this._sourceTarget.texture;let r=this._integrationMaterial.uniforms;r.envMap.value=this._sourceTarget.texture,r.sourceLod.value=Math.log2(e/dp);for(let o=0;o<=n;o++){let l=i.lodToRoughness(o,n);if(o>n-Y_)r.roughness.value=l,this._renderCube(t,o,this._integrationMaterial);else{let a=l>0?Math.log2(e)+.5*Math.log2(6/(fp*Math.pow(l,4)))+.5:0;s.roughness.value=l,s.lodBias.value=a,this._renderCube(t,o,this._ggxMaterial)}}}_blur(t,e){this._blurMaterial===null&&(this._blurMaterial=Q_());let n=this._blurMaterial,s=n.uniforms,r=this._sourceTarget;s.sigma.value=Math.min(e,Math.PI)/Math.SQRT2,s.envMap.value=r.texture,this._renderCube(t,0,n),s.envMap.value=t.texture,this._renderCube(r,0,n)}};function Wd(i,t,e){return new oo(i,{minFilter:vi,generateMipmaps:t,type:Wn,colorSpace:Lr,depthBuffer:e})}function ao(i,t,e){return new je({name:i,uniforms:t,vertexShader:Gt.cube_vert,fragmentShader:e,side:qe,blending:hs,depthTest:!1,depthWrite:!1})}function J_(){return ao("PMREMGGXConvolution",{envMap:{value:null},roughness:{value:0},lodBias:{value:0}},`

		#define GGX_SAMPLES ${fp}u

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float roughness;
		uniform float lodBias;

		#include <common>

		// Van der Corput radical inverse
		float radicalInverse_VdC( uint bits ) {

			bits = ( bits << 16u ) | ( bits >> 16u );
			bits = ( ( bits & 0x55555555u ) << 1u ) | ( ( bits & 0xAAAAAAAAu ) >> 1u );
			bits = ( ( bits & 0x33333333u ) << 2u ) | ( ( bits & 0xCCCCCCCCu ) >> 2u );
			bits = ( ( bits & 0x0F0F0F0Fu ) << 4u ) | ( ( bits & 0xF0F0F0F0u ) >> 4u );
			bits = ( ( bits & 0x00FF00FFu ) << 8u ) | ( ( bits & 0xFF00FF00u ) >> 8u );
			return float( bits ) * 2.3283064365386963e-10; // / 0x100000000

		}

		// Hammersley sequence
		vec2 hammersley( uint i, uint N ) {

			return vec2( float( i ) / float( N ), radicalInverse_VdC( i ) );

		}

		void main() {

			vec3 N = normalize( vWorldDirection );

			// For very low roughness, just sample the environment directly
			if ( roughness < 0.001 ) {

				gl_FragColor = vec4( textureLod( envMap, N, 0.0 ).rgb, 1.0 );
				return;

			}

			float alpha = roughness * roughness;
			float alpha2 = alpha * alpha;

			// Tangent space basis for VNDF sampling
			vec3 up = abs( N.z ) < 0.999 ? vec3( 0.0, 0.0, 1.0 ) : vec3( 1.0, 0.0, 0.0 );
			vec3 tangent = normalize( cross( up, N ) );
			vec3 bitangent = cross( N, tangent );

			vec3 prefilteredColor = vec3( 0.0 );
			float totalWeight = 0.0;

			for ( uint i = 0u; i < GGX_SAMPLES; i ++ ) {

				vec2 Xi = hammersley( i, GGX_SAMPLES );

				// With V = N, sample the reflected direction directly.
				float invQ = 1.0 / ( 1.0 - Xi.x + alpha2 * Xi.x );
				float NdotL = ( 1.0 - Xi.x - alpha2 * Xi.x ) * invQ;

				if ( NdotL > 0.0 ) {

					float phi = 2.0 * PI * Xi.y;
					float sinTheta = 2.0 * alpha * sqrt( Xi.x * ( 1.0 - Xi.x ) ) * invQ;
					vec3 L = N * NdotL + ( tangent * cos( phi ) + bitangent * sin( phi ) ) * sinTheta;

					// Match the source mip to the sample's solid angle. The terms
					// independent of the sample are precomputed in lodBias.
					float d = alpha2 * invQ;
					float lod = max( log2( d ) + lodBias, 0.0 );

					// Weight by NdotL for the split-sum approximation
					prefilteredColor += textureLod( envMap, L, lod ).rgb * NdotL;
					totalWeight += NdotL;

				}

			}

			gl_FragColor = vec4( prefilteredColor / totalWeight, 1.0 );

		}
	`)}function K_(){return ao("PMREMGGXIntegration",{envMap:{value:null},roughness:{value:0},sourceLod:{value:0},sourceSize:{value:dp}},`

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float roughness;
		uniform float sourceLod;
		uniform int sourceSize;

		void main() {

			vec3 N = normalize( vWorldDirection );

			float alpha = roughness * roughness;
			float alpha2 = alpha * alpha;

			float texelSize = 2.0 / float( sourceSize );

			vec3 prefilteredColor = vec3( 0.0 );
			float totalWeight = 0.0;

			// Pair opposite texels: only the one in N's hemisphere contributes.
			for ( int face = 0; face < 3; face ++ ) {

				for ( int y = 0; y < sourceSize; y ++ ) {

					for ( int x = 0; x < sourceSize; x ++ ) {

						vec2 uv = ( vec2( x, y ) + 0.5 ) * texelSize - 1.0;
						vec3 texelDirection = face == 0 ? vec3( 1.0, uv ) : ( face == 1 ? vec3( uv.x, 1.0, uv.y ) : vec3( uv, 1.0 ) );

						float invDistance = inversesqrt( 1.0 + dot( uv, uv ) );
						float NdotL = dot( N, texelDirection );
						texelDirection *= NdotL < 0.0 ? - 1.0 : 1.0;
						NdotL = abs( NdotL ) * invDistance;

						// With V = N, NdotH squared is ( 1 + NdotL ) / 2. Common factors
						// in the GGX distribution and texel solid angle cancel when normalized.
						float d = 1.0 + alpha2 + ( alpha2 - 1.0 ) * NdotL;
						float weight = NdotL * invDistance * invDistance * invDistance / ( d * d );

						prefilteredColor += textureLod( envMap, texelDirection, sourceLod ).rgb * weight;
						totalWeight += weight;

					}

				}

			}

			gl_FragColor = vec4( prefilteredColor / totalWeight, 1.0 );

		}
	`)}function Q_(){return ao("PMREMSphericalGaussianBlur",{envMap:{value:null},sigma:{value:0}},`

		#define SAMPLES ${q_}
		#define GOLDEN_ANGLE 2.39996322973

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float sigma;

		#include <common>

		void main() {

			vec3 outputDirection = normalize( vWorldDirection );

			vec3 up = abs( outputDirection.z ) < 0.999 ? vec3( 0.0, 0.0, 1.0 ) : vec3( 1.0, 0.0, 0.0 );
			vec3 tangent = normalize( cross( up, outputDirection ) );
			vec3 bitangent = cross( outputDirection, tangent );

			// Truncate the kernel at three standard deviations or at the antipode.
			float thetaMax = min( 3.0 * sigma, PI );
			float truncation = 1.0 - exp( - 0.5 * thetaMax * thetaMax / ( sigma * sigma ) );

			vec3 accumColor = vec3( 0.0 );
			float accumWeight = 0.0;

			for ( int i = 0; i < SAMPLES; i ++ ) {

				// Stratified inverse-CDF sampling of the Gaussian, placed on a golden-angle spiral.
				float stratum = ( float( i ) + 0.5 ) / float( SAMPLES );
				float theta = sigma * sqrt( - 2.0 * log( 1.0 - stratum * truncation ) );
				float phi = float( i ) * GOLDEN_ANGLE;

				vec3 offset = cos( phi ) * tangent + sin( phi ) * bitangent;
				vec3 sampleDirection = cos( theta ) * outputDirection + sin( theta ) * offset;

				// Correct the planar sample density to solid angle.
				float weight = sin( theta ) / theta;

				accumColor += weight * textureLod( envMap, sampleDirection, 0.0 ).rgb;
				accumWeight += weight;

			}

			gl_FragColor = vec4( accumColor / accumWeight, 1.0 );

		}
	`)}function Xd(){return ao("PMREMEquirectangularToCubemap",{envMap:{value:null}},`

		varying vec3 vWorldDirection;

		uniform sampler2D envMap;

		#include <common>

		void main() {

			// Average four subpixel samples to preserve small, bright features.
			vec3 direction = normalize( vWorldDirection );
			vec3 dx = dFdx( direction ) * 0.25;
			vec3 dy = dFdy( direction ) * 0.25;

			vec3 color = textureLod( envMap, equirectUv( normalize( direction - dx - dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction + dx - dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction - dx + dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction + dx + dy ) ), 0.0 ).rgb;
			gl_FragColor = vec4( color * 0.25, 1.0 );

		}
	`)}function qd(){return ao("PMREMCubemapToCubemap",{envMap:{value:null},flipEnvMap:{value:-1}},`

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float flipEnvMap;

		void main() {

			gl_FragColor = vec4( textureCube( envMap, vec3( flipEnvMap * vWorldDirection.x, vWorldDirection.yz ) ).rgb, 1.0 );

		}
	`)}function j_(i){let t=new WeakMap,e=new WeakMap,n=null;function s(f,d=!1){return f==null?null:d?o(f):r(f)}function r(f){if(f&&f.isTexture){let d=f.mapping;if(d===ka||d===Va)if(t.has(f)){let g=t.get(f).texture;return l(g,f.mapping)}else{let g=f.image;if(g&&g.height>0){let y=new oo(g.height);return y.fromEquirectangularTexture(i,f),t.set(f,y),f.addEventListener("dispose",c),l(y.texture,f.mapping)}else return null}}return f}function o(f){if(f&&f.isTexture&&f.isPMREMTexture!==!0){let d=f.mapping,g=d===ka||d===Va,y=d===ds||d===Ks;if(g||y){let p=e.get(f),m=p!==void 0?p.texture.pmremVersion:0;if(f.isRenderTargetTexture&&f.pmremVersion!==m)return n===null&&(n=new Rl(i)),p=g?n.fromEquirectangular(f,p):n.fromCubemap(f,p),p.texture.pmremVersion=f.pmremVersion,e.set(f,p),p.texture;if(p!==void 0)return p.texture;{let x=f.image;return g&&x&&x.height>0||y&&x&&a(x)?(n===null&&(n=new Rl(i)),p=g?n.fromEquirectangular(f):n.fromCubemap(f),p.texture.pmremVersion=f.pmremVersion,e.set(f,p),f.addEventListener("dispose",u),p.texture):null}}}return f}function l(f,d){return d===ka?f.mapping=ds:d===Va&&(f.mapping=Ks),f}function a(f){let d=0,g=6;for(let y=0;y<g;y++)f[y]!==void 0&&d++;return d===g}function c(f){let d=f.target;d.removeEventListener("dispose",c);let g=t.get(d);g!==void 0&&(t.delete(d),g.dispose())}function u(f){let d=f.target;d.removeEventListener("dispose",u);let g=e.get(d);g!==void 0&&(e.delete(d),g.dispose())}function h(){t=new WeakMap,e=new WeakMap,n!==null&&(n.dispose(),n=null)}return{get:s,dispose:h}}function ty(i){let t={};function e(n){if(t[n]!==void 0)return t[n];let s=i.getExtension(n);return t[n]=s,s}return{has:function(n){return e(n)!==null},init:function(){e("EXT_color_buffer_float"),e("WEBGL_clip_cull_distance"),e("OES_texture_float_linear"),e("EXT_color_buffer_half_float"),e("WEBGL_multisampled_render_to_texture"),e("WEBGL_render_shared_exponent")},get:function(n){let s=e(n);return s===null&&Pr("WebGLRenderer: "+n+" extension not supported."),s}}}function ey(i,t,e,n){let s={},r=new WeakMap,o=new FinalizationRegistry(g=>delete s[g]);function l(g){a(g.target)}function a(g){g.index!==null&&t.remove(g.index);for(let p in g.attributes)t.remove(g.attributes[p]);g.removeEventListener("dispose",l),delete s[g.id],o.unregister(g);let y=r.get(g);y&&(t.remove(y),r.delete(g)),n.releaseStatesOfGeometry(g),g.isInstancedBufferGeometry===!0&&delete g._maxInstanceCount,e.memory.geometries--}function c(g,y){return s[y.id]!==void 0||(y.addEventListener("dispose",l),s[y.id]=new WeakRef(y),o.register(y,y.id,y),e.memory.geometries++),y}function u(g){let y=g.attributes;for(let p in y)t.update(y[p],i.ARRAY_BUFFER)}function h(g){let y=g.index,p=g.attributes.position,m=0;if(p===void 0)return;let x=y!==null?y.array.length:p.array.length/3-1,M=p.count>=65535?zr:Br,v=new M(Math.ceil(x/3)*6,1),S=v.array;if(y!==null){let _=y.array;m=y.version;for(let b=0,L=0;b<x;b+=3){let E=_[b+0],C=_[b+1],I=_[b+2];S[L++]=E,S[L++]=C,S[L++]=C,S[L++]=I,S[L++]=I,S[L++]=E}}else{m=p.version;for(let _=0,b=0;_<x;_+=3){let L=_+0,E=_+1,C=_+2;S[b++]=L,S[b++]=E,S[b++]=E,S[b++]=C,S[b++]=C,S[b++]=L}}v.version=m;let A=r.get(g);A&&t.remove(A),r.set(g,v)}function f(g){let y=r.get(g);if(y){let p=g.index;p!==null&&y.version<p.version&&h(g)}else h(g);return r.get(g)}function d(){for(let g in s){let y=s[g].deref();y!==void 0&&a(y)}}return{get:c,update:u,getWireframeAttribute:f,dispose:d}}function ny(i,t,e){let n;function s(h){n=h}let r,o;function l(h){r=h.type,o=h.bytesPerElement}function a(h,f){i.drawElements(n,f,r,h*o),e.update(f,n,1)}function c(h,f,d){d!==0&&(i.drawElementsInstanced(n,f,r,h*o,d),e.update(f,n,d))}function u(h,f,d){if(d===0)return;t.get("WEBGL_multi_draw").multiDrawElementsWEBGL(n,f,0,r,h,0,d);let y=0;for(let p=0;p<d;p++)y+=f[p];e.update(y,n,1)}this.setMode=s,this.setIndex=l,this.render=a,this.renderInstances=c,this.renderMultiDraw=u}function iy(i){let t={geometries:0,textures:0},e={frame:0,calls:0,triangles:0,points:0,lines:0};function n(r,o,l){switch(e.calls++,o){case i.TRIANGLES:e.triangles+=l*(r/3);break;case i.LINES:e.lines+=l*(r/2);break;case i.LINE_STRIP:e.lines+=l*(r-1);break;case i.LINE_LOOP:e.lines+=l*r;break;case i.POINTS:e.points+=l*r;break;default:Lt("WebGLInfo: Unknown draw mode:",o);break}}function s(){e.calls=0,e.triangles=0,e.points=0,e.lines=0}return{memory:t,render:e,programs:null,autoReset:!0,reset:s,update:n}}function sy(i,t,e){let n=new WeakMap,s=new me;function r(o,l,a){let c=o.morphTargetInfluences,u=l.morphAttributes.position||l.morphAttributes.normal||l.morphAttributes.color,h=u!==void 0?u.length:0,f=n.get(l);if(f===void 0||f.count!==h){let L=function(){_.dispose(),n.delete(l),l.removeEventListener("dispose",L)};f!==void 0&&f.texture.dispose();let d=l.morphAttributes.position!==void 0,g=l.morphAttributes.normal!==void 0,y=l.morphAttributes.color!==void 0,p=l.morphAttributes.position||[],m=l.morphAttributes.normal||[],x=l.morphAttributes.color||[],M=0;d===!0&&(M=1),g===!0&&(M=2),y===!0&&(M=3);let v=l.attributes.position.count*M,S=1;v>t.maxTextureSize&&(S=Math.ceil(v/t.maxTextureSize),v=t.maxTextureSize);let A=new Float32Array(v*S*4*h),_=new Fr(A,v,S,h);_.type=Hn,_.needsUpdate=!0;let b=M*4;for(let E=0;E<h;E++){let C=p[E],I=m[E],U=x[E],P=v*S*4*E;for(let B=0;B<C.count;B++){let H=B*b;d===!0&&(s.fromBufferAttribute(C,B),A[P+H+0]=s.x,A[P+H+1]=s.y,A[P+H+2]=s.z,A[P+H+3]=0),g===!0&&(s.fromBufferAttribute(I,B),A[P+H+4]=s.x,A[P+H+5]=s.y,A[P+H+6]=s.z,A[P+H+7]=0),y===!0&&(s.fromBufferAttribute(U,B),A[P+H+8]=s.x,A[P+H+9]=s.y,A[P+H+10]=s.z,A[P+H+11]=U.itemSize===4?s.w:1)}}f={count:h,texture:_,size:new Et(v,S)},n.set(l,f),l.addEventListener("dispose",L)}if(o.isInstancedMesh===!0&&o.morphTexture!==null)a.getUniforms().setValue(i,"morphTexture",o.morphTexture,e);else{let d=0;for(let y=0;y<c.length;y++)d+=c[y];let g=l.morphTargetsRelative?1:1-d;a.getUniforms().setValue(i,"morphTargetBaseInfluence",g),a.getUniforms().setValue(i,"morphTargetInfluences",c)}a.getUniforms().setValue(i,"morphTargetsTexture",f.texture,e),a.getUniforms().setValue(i,"morphTargetsTextureSize",f.size)}return{update:r}}function ry(i,t,e,n,s){let r=new WeakMap;function o(c){let u=s.render.frame,h=c.geometry,f=t.get(c,h);if(r.get(f)!==u&&(t.update(f),r.set(f,u)),c.isInstancedMesh&&(c.hasEventListener("dispose",a)===!1&&c.addEventListener("dispose",a),r.get(c)!==u&&(e.update(c.instanceMatrix,i.ARRAY_BUFFER),c.instanceColor!==null&&e.update(c.instanceColor,i.ARRAY_BUFFER),r.set(c,u))),c.isSkinnedMesh){let d=c.skeleton;r.get(d)!==u&&(d.update(),r.set(d,u))}return f}function l(){r=new WeakMap}function a(c){let u=c.target;u.removeEventListener("dispose",a),n.releaseStatesOfObject(u),e.remove(u.instanceMatrix),u.instanceColor!==null&&e.remove(u.instanceColor)}return{update:o,dispose:l}}var oy={[Tu]:"LINEAR_TONE_MAPPING",[Eu]:"REINHARD_TONE_MAPPING",[Ru]:"CINEON_TONE_MAPPING",[Cu]:"ACES_FILMIC_TONE_MAPPING",[Iu]:"AGX_TONE_MAPPING",[Lu]:"NEUTRAL_TONE_MAPPING",[Pu]:"CUSTOM_TONE_MAPPING"};function ay(i,t,e,n,s,r){let o=new on(t,e,{type:i,depthBuffer:s,stencilBuffer:r,samples:n?4:0,storeMultisampledDepthBuffer:!1,storeMultisampledStencilBuffer:!1,resolveDepthBuffer:!1,resolveStencilBuffer:!1}),l=null,a=null,c=null,u=new Xe;u.setAttribute("position",new We([-1,3,0,-1,-1,0,3,-1,0],3)),u.setAttribute("uv",new We([0,2,0,0,2,0],2));let h=new Ta({uniforms:{tDiffuse:{value:null}},vertexShader:`
			precision highp float;

			uniform mat4 modelViewMatrix;
			uniform mat4 projectionMatrix;

			attribute vec3 position;
			attribute vec2 uv;

			varying vec2 vUv;

			void main() {
				vUv = uv;
				gl_Position = projectionMatrix * modelViewMatrix * vec4( position, 1.0 );
			}`,fragmentShader:`
			precision highp float;

			uniform sampler2D tDiffuse;

			varying vec2 vUv;

			#include <tonemapping_pars_fragment>
			#include <colorspace_pars_fragment>

			void main() {
				gl_FragColor = texture2D( tDiffuse, vUv );

				#ifdef LINEAR_TONE_MAPPING
					gl_FragColor.rgb = LinearToneMapping( gl_FragColor.rgb );
				#elif defined( REINHARD_TONE_MAPPING )
					gl_FragColor.rgb = ReinhardToneMapping( gl_FragColor.rgb );
				#elif defined( CINEON_TONE_MAPPING )
					gl_FragColor.rgb = CineonToneMapping( gl_FragColor.rgb );
				#elif defined( ACES_FILMIC_TONE_MAPPING )
					gl_FragColor.rgb = ACESFilmicToneMapping( gl_FragColor.rgb );
				#elif defined( AGX_TONE_MAPPING )
					gl_FragColor.rgb = AgXToneMapping( gl_FragColor.rgb );
				#elif defined( NEUTRAL_TONE_MAPPING )
					gl_FragColor.rgb = NeutralToneMapping( gl_FragColor.rgb );
				#elif defined( CUSTOM_TONE_MAPPING )
					gl_FragColor.rgb = CustomToneMapping( gl_FragColor.rgb );
				#endif

				#ifdef SRGB_TRANSFER
					gl_FragColor = sRGBTransferOETF( gl_FragColor );
				#endif
			}`,depthTest:!1,depthWrite:!1}),f=new de(u,h),d=new Gi(-1,1,1,-1,0,1),g=null,y=null,p=!1,m,x=null,M=[],v=!1;this.setSize=function(S,A){o.setSize(S,A),l!==null&&l.setSize(S,A),a!==null&&a.setSize(S,A);for(let _=0;_<M.length;_++){let b=M[_];b.setSize&&b.setSize(S,A)}},this.setEffects=function(S){M=S,v=M.length>0&&M[0].isRenderPass===!0;let A=o.width,_=o.height;M.length>0&&l===null&&(l=new on(A,_,{type:Wn,depthBuffer:!1,stencilBuffer:!1}),a=new on(A,_,{type:Wn,depthBuffer:!1,stencilBuffer:!1}));let b=s===!0&&M.some(L=>L.needsDepthTexture===!0);b!==(o.depthTexture!==null)&&(b===!0&&c===null&&(c=new _i(A,_),r===!0&&(c.format=Mi,c.type=ps)),o.dispose(),o.depthTexture=b?c:null,o.resolveDepthBuffer=b,o.storeMultisampledDepthBuffer=b);for(let L=0;L<M.length;L++){let E=M[L];E.setSize&&E.setSize(A,_),b&&E.needsDepthTexture===!0&&E.setDepthTexture&&E.setDepthTexture(c)}},this.begin=function(S,A){if(p||S.toneMapping===Qn&&M.length===0)return!1;if(x=A,A!==null){let _=A.width,b=A.height;(o.width!==_||o.height!==b)&&this.setSize(_,b)}return v===!1&&S.setRenderTarget(o),m=S.toneMapping,S.toneMapping=Qn,!0},this.hasRenderPass=function(){return v},this.end=function(S,A){S.toneMapping=m,p=!0;let _=o,b=l;for(let L=0;L<M.length;L++){let E=M[L];E.enabled!==!1&&(E.render(S,b,_,A),E.needsSwap!==!1&&(_=b,b=b===l?a:l))}if(g!==S.outputColorSpace||y!==S.toneMapping){g=S.outputColorSpace,y=S.toneMapping,h.defines={},Yt.getTransfer(g)===ne&&(h.defines.SRGB_TRANSFER="");let L=oy[y];L&&(h.defines[L]=""),h.needsUpdate=!0}h.uniforms.tDiffuse.value=_.texture,S.setRenderTarget(x),S.render(f,d),x=null,p=!1},this.isCompositing=function(){return p},this.dispose=function(){o.dispose(),l!==null&&l.dispose(),a!==null&&a.dispose(),u.dispose(),h.dispose()}}var pp=new hn,mp=new _i(1,1),gp=new Gr(1),xp=new Fr,_p=new ya,yp=new Vr,Yd=[],$d=[],Zd=new Float32Array(16),Jd=new Float32Array(9),Kd=new Float32Array(4);function tr(i,t,e){let n=i[0];if(n<=0||n>0)return i;let s=t*e,r=Yd[s];if(r===void 0&&(r=new Float32Array(s),Yd[s]=r),t!==0){n.toArray(r,0);for(let o=1,l=0;o!==t;++o)l+=e,i[o].toArray(r,l)}return r}function De(i,t){if(i.length!==t.length)return!1;for(let e=0,n=i.length;e<n;e++)if(i[e]!==t[e])return!1;return!0}function Ue(i,t){for(let e=0,n=t.length;e<n;e++)i[e]=t[e]}function Il(i,t){let e=$d[t];e===void 0&&(e=new Int32Array(t),$d[t]=e);for(let n=0;n!==t;++n)e[n]=i.allocateTextureUnit();return e}function ly(i,t){let e=this.cache;e[0]!==t&&(i.uniform1f(this.addr,t),e[0]=t)}function cy(i,t){let e=this.cache;if(t.x!==void 0)(e[0]!==t.x||e[1]!==t.y)&&(i.uniform2f(this.addr,t.x,t.y),e[0]=t.x,e[1]=t.y);else{if(De(e,t))return;i.uniform2fv(this.addr,t),Ue(e,t)}}function uy(i,t){let e=this.cache;if(t.x!==void 0)(e[0]!==t.x||e[1]!==t.y||e[2]!==t.z)&&(i.uniform3f(this.addr,t.x,t.y,t.z),e[0]=t.x,e[1]=t.y,e[2]=t.z);else if(t.r!==void 0)(e[0]!==t.r||e[1]!==t.g||e[2]!==t.b)&&(i.uniform3f(this.addr,t.r,t.g,t.b),e[0]=t.r,e[1]=t.g,e[2]=t.b);else{if(De(e,t))return;i.uniform3fv(this.addr,t),Ue(e,t)}}function hy(i,t){let e=this.cache;if(t.x!==void 0)(e[0]!==t.x||e[1]!==t.y||e[2]!==t.z||e[3]!==t.w)&&(i.uniform4f(this.addr,t.x,t.y,t.z,t.w),e[0]=t.x,e[1]=t.y,e[2]=t.z,e[3]=t.w);else{if(De(e,t))return;i.uniform4fv(this.addr,t),Ue(e,t)}}function fy(i,t){let e=this.cache,n=t.elements;if(n===void 0){if(De(e,t))return;i.uniformMatrix2fv(this.addr,!1,t),Ue(e,t)}else{if(De(e,n))return;Kd.set(n),i.uniformMatrix2fv(this.addr,!1,Kd),Ue(e,n)}}function dy(i,t){let e=this.cache,n=t.elements;if(n===void 0){if(De(e,t))return;i.uniformMatrix3fv(this.addr,!1,t),Ue(e,t)}else{if(De(e,n))return;Jd.set(n),i.uniformMatrix3fv(this.addr,!1,Jd),Ue(e,n)}}function py(i,t){let e=this.cache,n=t.elements;if(n===void 0){if(De(e,t))return;i.uniformMatrix4fv(this.addr,!1,t),Ue(e,t)}else{if(De(e,n))return;Zd.set(n),i.uniformMatrix4fv(this.addr,!1,Zd),Ue(e,n)}}function my(i,t){let e=this.cache;e[0]!==t&&(i.uniform1i(this.addr,t),e[0]=t)}function gy(i,t){let e=this.cache;if(t.x!==void 0)(e[0]!==t.x||e[1]!==t.y)&&(i.uniform2i(this.addr,t.x,t.y),e[0]=t.x,e[1]=t.y);else{if(De(e,t))return;i.uniform2iv(this.addr,t),Ue(e,t)}}function xy(i,t){let e=this.cache;if(t.x!==void 0)(e[0]!==t.x||e[1]!==t.y||e[2]!==t.z)&&(i.uniform3i(this.addr,t.x,t.y,t.z),e[0]=t.x,e[1]=t.y,e[2]=t.z);else{if(De(e,t))return;i.uniform3iv(this.addr,t),Ue(e,t)}}function _y(i,t){let e=this.cache;if(t.x!==void 0)(e[0]!==t.x||e[1]!==t.y||e[2]!==t.z||e[3]!==t.w)&&(i.uniform4i(this.addr,t.x,t.y,t.z,t.w),e[0]=t.x,e[1]=t.y,e[2]=t.z,e[3]=t.w);else{if(De(e,t))return;i.uniform4iv(this.addr,t),Ue(e,t)}}function yy(i,t){let e=this.cache;e[0]!==t&&(i.uniform1ui(this.addr,t),e[0]=t)}function vy(i,t){let e=this.cache;if(t.x!==void 0)(e[0]!==t.x||e[1]!==t.y)&&(i.uniform2ui(this.addr,t.x,t.y),e[0]=t.x,e[1]=t.y);else{if(De(e,t))return;i.uniform2uiv(this.addr,t),Ue(e,t)}}function My(i,t){let e=this.cache;if(t.x!==void 0)(e[0]!==t.x||e[1]!==t.y||e[2]!==t.z)&&(i.uniform3ui(this.addr,t.x,t.y,t.z),e[0]=t.x,e[1]=t.y,e[2]=t.z);else{if(De(e,t))return;i.uniform3uiv(this.addr,t),Ue(e,t)}}function Sy(i,t){let e=this.cache;if(t.x!==void 0)(e[0]!==t.x||e[1]!==t.y||e[2]!==t.z||e[3]!==t.w)&&(i.uniform4ui(this.addr,t.x,t.y,t.z,t.w),e[0]=t.x,e[1]=t.y,e[2]=t.z,e[3]=t.w);else{if(De(e,t))return;i.uniform4uiv(this.addr,t),Ue(e,t)}}function Ll(i){return i.version===0&&(i.compareFunction=qu,i.needsUpdate=!0),i}function by(i,t,e){let n=this.cache,s=e.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s);let r;this.type===i.SAMPLER_2D_SHADOW?r=Ll(mp):r=pp,e.setTexture2D(t||r,s)}function wy(i,t,e){let n=this.cache,s=e.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s),e.setTexture3D(t||_p,s)}function Ay(i,t,e){let n=this.cache,s=e.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s);let r;this.type===i.SAMPLER_CUBE_SHADOW?r=Ll(gp):r=yp,e.setTextureCube(t||r,s)}function Ty(i,t,e){let n=this.cache,s=e.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s),e.setTexture2DArray(t||xp,s)}function Ey(i){switch(i){case 5126:return ly;case 35664:return cy;case 35665:return uy;case 35666:return hy;case 35674:return fy;case 35675:return dy;case 35676:return py;case 5124:case 35670:return my;case 35667:case 35671:return gy;case 35668:case 35672:return xy;case 35669:case 35673:return _y;case 5125:return yy;case 36294:return vy;case 36295:return My;case 36296:return Sy;case 35678:case 36198:case 36298:case 36306:case 35682:return by;case 35679:case 36299:case 36307:return wy;case 35680:case 36300:case 36308:case 36293:return Ay;case 36289:case 36303:case 36311:case 36292:return Ty}}function Ry(i,t){i.uniform1fv(this.addr,t)}function Cy(i,t){let e=tr(t,this.size,2);i.uniform2fv(this.addr,e)}function Py(i,t){let e=tr(t,this.size,3);i.uniform3fv(this.addr,e)}function Iy(i,t){let e=tr(t,this.size,4);i.uniform4fv(this.addr,e)}function Ly(i,t){let e=tr(t,this.size,4);i.uniformMatrix2fv(this.addr,!1,e)}function Ny(i,t){let e=tr(t,this.size,9);i.uniformMatrix3fv(this.addr,!1,e)}function Dy(i,t){let e=tr(t,this.size,16);i.uniformMatrix4fv(this.addr,!1,e)}function Uy(i,t){i.uniform1iv(this.addr,t)}function Fy(i,t){i.uniform2iv(this.addr,t)}function Oy(i,t){i.uniform3iv(this.addr,t)}function By(i,t){i.uniform4iv(this.addr,t)}function zy(i,t){i.uniform1uiv(this.addr,t)}function ky(i,t){i.uniform2uiv(this.addr,t)}function Vy(i,t){i.uniform3uiv(this.addr,t)}function Gy(i,t){i.uniform4uiv(this.addr,t)}function Hy(i,t,e){let n=this.cache,s=t.length,r=Il(e,s);De(n,r)||(i.uniform1iv(this.addr,r),Ue(n,r));let o;this.type===i.SAMPLER_2D_SHADOW?o=Ll(mp):o=pp;for(let l=0;l!==s;++l)e.setTexture2D(t[l]||o,r[l])}function Wy(i,t,e){let n=this.cache,s=t.length,r=Il(e,s);De(n,r)||(i.uniform1iv(this.addr,r),Ue(n,r));for(let o=0;o!==s;++o)e.setTexture3D(t[o]||_p,r[o])}function Xy(i,t,e){let n=this.cache,s=t.length,r=Il(e,s);De(n,r)||(i.uniform1iv(this.addr,r),Ue(n,r));let o;this.type===i.SAMPLER_CUBE_SHADOW?o=Ll(gp):o=yp;for(let l=0;l!==s;++l)e.setTextureCube(t[l]||o,r[l])}function qy(i,t,e){let n=this.cache,s=t.length,r=Il(e,s);De(n,r)||(i.uniform1iv(this.addr,r),Ue(n,r));for(let o=0;o!==s;++o)e.setTexture2DArray(t[o]||xp,r[o])}function Yy(i){switch(i){case 5126:return Ry;case 35664:return Cy;case 35665:return Py;case 35666:return Iy;case 35674:return Ly;case 35675:return Ny;case 35676:return Dy;case 5124:case 35670:return Uy;case 35667:case 35671:return Fy;case 35668:case 35672:return Oy;case 35669:case 35673:return By;case 5125:return zy;case 36294:return ky;case 36295:return Vy;case 36296:return Gy;case 35678:case 36198:case 36298:case 36306:case 35682:return Hy;case 35679:case 36299:case 36307:return Wy;case 35680:case 36300:case 36308:case 36293:return Xy;case 36289:case 36303:case 36311:case 36292:return qy}}var eh=class{constructor(t,e,n){this.id=t,this.addr=n,this.cache=[],this.type=e.type,this.setValue=Ey(e.type)}},nh=class{constructor(t,e,n){this.id=t,this.addr=n,this.cache=[],this.type=e.type,this.size=e.size,this.setValue=Yy(e.type)}},ih=class{constructor(t){this.id=t,this.seq=[],this.map={}}setValue(t,e,n){let s=this.seq;for(let r=0,o=s.length;r!==o;++r){let l=s[r];l.setValue(t,e[l.id],n)}}},ju=/(\w+)(\])?(\[|\.)?/g;function Qd(i,t){i.seq.push(t),i.map[t.id]=t}function $y(i,t,e){let n=i.name,s=n.length;for(ju.lastIndex=0;;){let r=ju.exec(n),o=ju.lastIndex,l=r[1],a=r[2]==="]",c=r[3];if(a&&(l=l|0),c===void 0||c==="["&&o+2===s){Qd(e,c===void 0?new eh(l,i,t):new nh(l,i,t));break}else{let h=e.map[l];h===void 0&&(h=new ih(l),Qd(e,h)),e=h}}}var js=class{constructor(t,e){this.seq=[],this.map={};let n=t.getProgramParameter(e,t.ACTIVE_UNIFORMS);for(let o=0;o<n;++o){let l=t.getActiveUniform(e,o),a=t.getUniformLocation(e,l.name);$y(l,a,this)}let s=[],r=[];for(let o of this.seq)o.type===t.SAMPLER_2D_SHADOW||o.type===t.SAMPLER_CUBE_SHADOW||o.type===t.SAMPLER_2D_ARRAY_SHADOW?s.push(o):r.push(o);s.length>0&&(this.seq=s.concat(r))}setValue(t,e,n,s){let r=this.map[e];r!==void 0&&r.setValue(t,n,s)}setOptional(t,e,n){let s=e[n];s!==void 0&&this.setValue(t,n,s)}static upload(t,e,n,s){for(let r=0,o=e.length;r!==o;++r){let l=e[r],a=n[l.id];a.needsUpdate!==!1&&l.setValue(t,a.value,s)}}static seqWithValue(t,e){let n=[];for(let s=0,r=t.length;s!==r;++s){let o=t[s];o.id in e&&n.push(o)}return n}};function jd(i,t,e){let n=i.createShader(t);return i.shaderSource(n,e),i.compileShader(n),n}var Zy=37297,Jy=0;function Ky(i,t){let e=i.split(`
`),n=[],s=Math.max(t-6,0),r=Math.min(t+6,e.length);for(let o=s;o<r;o++){let l=o+1;n.push(`${l===t?">":" "} ${l}: ${e[o]}`)}return n.join(`
`)}var tp=new Dt;function Qy(i){Yt._getMatrix(tp,Yt.workingColorSpace,i);let t=`mat3( ${tp.elements.map(e=>e.toFixed(4))} )`;switch(Yt.getTransfer(i)){case Nr:return[t,"LinearTransferOETF"];case ne:return[t,"sRGBTransferOETF"];default:return Rt("WebGLProgram: Unsupported color space: ",i),[t,"LinearTransferOETF"]}}function ep(i,t,e){let n=i.getShaderParameter(t,i.COMPILE_STATUS),r=(i.getShaderInfoLog(t)||"").trim();if(n&&r==="")return"";let o=/ERROR: 0:(\d+)/.exec(r);if(o){let l=parseInt(o[1]);return e.toUpperCase()+`

`+r+`

`+Ky(i.getShaderSource(t),l)}else return r}function jy(i,t){let e=Qy(t);return[`vec4 ${i}( vec4 value ) {`,`	return ${e[1]}( vec4( ${e[0]} * value.rgb, value.a ) );`,"}"].join(`
`)}var tv={[Tu]:"Linear",[Eu]:"Reinhard",[Ru]:"Cineon",[Cu]:"ACESFilmic",[Iu]:"AgX",[Lu]:"Neutral",[Pu]:"Custom"};function ev(i,t){let e=tv[t];return e===void 0?(Rt("WebGLProgram: Unsupported toneMapping:",t),"vec3 "+i+"( vec3 color ) { return LinearToneMapping( color ); }"):"vec3 "+i+"( vec3 color ) { return "+e+"ToneMapping( color ); }"}var El=new N;function nv(){Yt.getLuminanceCoefficients(El);let i=El.x.toFixed(4),t=El.y.toFixed(4),e=El.z.toFixed(4);return["float luminance( const in vec3 rgb ) {",`	const vec3 weights = vec3( ${i}, ${t}, ${e} );`,"	return dot( weights, rgb );","}"].join(`
`)}function iv(i){return[i.extensionClipCullDistance?"#extension GL_ANGLE_clip_cull_distance : require":"",i.extensionMultiDraw?"#extension GL_ANGLE_multi_draw : require":""].filter(ro).join(`
`)}function sv(i){let t=[];for(let e in i){let n=i[e];n!==!1&&t.push("#define "+e+" "+n)}return t.join(`
`)}function rv(i,t){let e={},n=i.getProgramParameter(t,i.ACTIVE_ATTRIBUTES);for(let s=0;s<n;s++){let r=i.getActiveAttrib(t,s),o=r.name,l=1;r.type===i.FLOAT_MAT2&&(l=2),r.type===i.FLOAT_MAT3&&(l=3),r.type===i.FLOAT_MAT4&&(l=4),e[o]={type:r.type,location:i.getAttribLocation(t,o),locationSize:l}}return e}function ro(i){return i!==""}function np(i,t){let e=t.numSpotLightShadows+t.numSpotLightMaps-t.numSpotLightShadowsWithMaps;return i.replace(/NUM_SUN_LIGHTS/g,t.numSunLights).replace(/NUM_DIR_LIGHTS/g,t.numDirLights).replace(/NUM_SPOT_LIGHTS/g,t.numSpotLights).replace(/NUM_SPOT_LIGHT_MAPS/g,t.numSpotLightMaps).replace(/NUM_SPOT_LIGHT_COORDS/g,e).replace(/NUM_RECT_AREA_LIGHTS/g,t.numRectAreaLights).replace(/NUM_POINT_LIGHTS/g,t.numPointLights).replace(/NUM_HEMI_LIGHTS/g,t.numHemiLights).replace(/NUM_SUN_LIGHT_SHADOWS/g,t.numSunLightShadows).replace(/NUM_DIR_LIGHT_SHADOWS/g,t.numDirLightShadows).replace(/NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS/g,t.numSpotLightShadowsWithMaps).replace(/NUM_SPOT_LIGHT_SHADOWS/g,t.numSpotLightShadows).replace(/NUM_POINT_LIGHT_SHADOWS/g,t.numPointLightShadows).replace(/NUM_LIGHT_PROBE_GRIDS/g,t.numLightProbeGrids)}function ip(i,t){return i.replace(/NUM_CLIPPING_PLANES/g,t.numClippingPlanes).replace(/UNION_CLIPPING_PLANES/g,t.numClippingPlanes-t.numClipIntersection)}var ov=/^[ \t]*#include +<([\w\d./]+)>/gm;function sh(i){return i.replace(ov,av)}function av(i,t){let e=Gt[t];if(e===void 0)throw new Error("THREE.WebGLProgram: Can not resolve #include <"+t+">");return sh(e)}var lv=/#pragma unroll_loop_start\s+for\s*\(\s*int\s+i\s*=\s*(\d+)\s*;\s*i\s*<\s*(\d+)\s*;\s*i\s*\+\+\s*\)\s*{([\s\S]+?)}\s+#pragma unroll_loop_end/g;function sp(i){return i.replace(lv,cv)}function cv(i,t,e,n){let s="";for(let r=parseInt(t);r<parseInt(e);r++)s+=n.replace(/\[\s*i\s*\]/g,"[ "+r+" ]").replace(/UNROLLED_LOOP_INDEX/g,r);return s}function rp(i){let t=`precision ${i.precision} float;
	precision ${i.precision} int;
	precision ${i.precision} sampler2D;
	precision ${i.precision} samplerCube;
	precision ${i.precision} sampler3D;
	precision ${i.precision} sampler2DArray;
	precision ${i.precision} sampler2DShadow;
	precision ${i.precision} samplerCubeShadow;
	precision ${i.precision} sampler2DArrayShadow;
	precision ${i.precision} isampler2D;
	precision ${i.precision} isampler3D;
	precision ${i.precision} isamplerCube;
	precision ${i.precision} isampler2DArray;
	precision ${i.precision} usampler2D;
	precision ${i.precision} usampler3D;
	precision ${i.precision} usamplerCube;
	precision ${i.precision} usampler2DArray;
	`;return i.precision==="highp"?t+=`
#define HIGH_PRECISION`:i.precision==="mediump"?t+=`
#define MEDIUM_PRECISION`:i.precision==="lowp"&&(t+=`
#define LOW_PRECISION`),t}var uv={[$r]:"SHADOWMAP_TYPE_PCF",[Zs]:"SHADOWMAP_TYPE_VSM"};function hv(i){return uv[i.shadowMapType]||"SHADOWMAP_TYPE_BASIC"}var fv={[Ks]:"ENVMAP_MODE_REFRACTION"};function dv(i){return i.envMap===!1?"ENVMAP_MODE_REFLECTION":fv[i.envMapMode]||"ENVMAP_MODE_REFLECTION"}var pv={[Au]:"ENVMAP_BLENDING_MULTIPLY",[bd]:"ENVMAP_BLENDING_MIX",[wd]:"ENVMAP_BLENDING_ADD"};function mv(i){return i.envMap===!1?"ENVMAP_BLENDING_NONE":pv[i.combine]||"ENVMAP_BLENDING_NONE"}function gv(i,t,e,n){let s=i.getContext(),r=e.defines,o=e.vertexShader,l=e.fragmentShader,a=hv(e),c=e.envMapPMREM===!0?"ENVMAP_TYPE_PMREM":"ENVMAP_TYPE_CUBE",u=dv(e),h=mv(e),f=iv(e),d=sv(r),g=s.createProgram(),y,p,m=e.glslVersion?"#version "+e.glslVersion+`
`:"";e.isRawShaderMaterial?(y=["#define SHADER_TYPE "+e.shaderType,"#define SHADER_NAME "+e.shaderName,d].filter(ro).join(`
`),y.length>0&&(y+=`
`),p=["#define SHADER_TYPE "+e.shaderType,"#define SHADER_NAME "+e.shaderName,d].filter(ro).join(`
`),p.length>0&&(p+=`
`)):(y=[rp(e),"#define SHADER_TYPE "+e.shaderType,"#define SHADER_NAME "+e.shaderName,d,e.extensionClipCullDistance?"#define USE_CLIP_DISTANCE":"",e.batching?"#define USE_BATCHING":"",e.batchingColor?"#define USE_BATCHING_COLOR":"",e.instancing?"#define USE_INSTANCING":"",e.instancingColor?"#define USE_INSTANCING_COLOR":"",e.instancingMorph?"#define USE_INSTANCING_MORPH":"",e.useFog&&e.fog?"#define USE_FOG":"",e.useFog&&e.fogExp2?"#define FOG_EXP2":"",e.map?"#define USE_MAP":"",e.envMap?"#define USE_ENVMAP":"",e.envMap?"#define "+u:"",e.lightMap?"#define USE_LIGHTMAP":"",e.aoMap?"#define USE_AOMAP":"",e.bumpMap?"#define USE_BUMPMAP":"",e.normalMap?"#define USE_NORMALMAP":"",e.normalMapObjectSpace?"#define USE_NORMALMAP_OBJECTSPACE":"",e.normalMapTangentSpace?"#define USE_NORMALMAP_TANGENTSPACE":"",e.displacementMap?"#define USE_DISPLACEMENTMAP":"",e.emissiveMap?"#define USE_EMISSIVEMAP":"",e.anisotropy?"#define USE_ANISOTROPY":"",e.anisotropyMap?"#define USE_ANISOTROPYMAP":"",e.clearcoatMap?"#define USE_CLEARCOATMAP":"",e.clearcoatRoughnessMap?"#define USE_CLEARCOAT_ROUGHNESSMAP":"",e.clearcoatNormalMap?"#define USE_CLEARCOAT_NORMALMAP":"",e.diffuseRoughnessMap?"#define USE_DIFFUSE_ROUGHNESSMAP":"",e.iridescenceMap?"#define USE_IRIDESCENCEMAP":"",e.iridescenceThicknessMap?"#define USE_IRIDESCENCE_THICKNESSMAP":"",e.specularMap?"#define USE_SPECULARMAP":"",e.specularColorMap?"#define USE_SPECULAR_COLORMAP":"",e.specularIntensityMap?"#define USE_SPECULAR_INTENSITYMAP":"",e.roughnessMap?"#define USE_ROUGHNESSMAP":"",e.metalnessMap?"#define USE_METALNESSMAP":"",e.alphaMap?"#define USE_ALPHAMAP":"",e.alphaHash?"#define USE_ALPHAHASH":"",e.transmission?"#define USE_TRANSMISSION":"",e.transmissionMap?"#define USE_TRANSMISSIONMAP":"",e.thicknessMap?"#define USE_THICKNESSMAP":"",e.sheenColorMap?"#define USE_SHEEN_COLORMAP":"",e.sheenRoughnessMap?"#define USE_SHEEN_ROUGHNESSMAP":"",e.mapUv?"#define MAP_UV "+e.mapUv:"",e.alphaMapUv?"#define ALPHAMAP_UV "+e.alphaMapUv:"",e.lightMapUv?"#define LIGHTMAP_UV "+e.lightMapUv:"",e.aoMapUv?"#define AOMAP_UV "+e.aoMapUv:"",e.emissiveMapUv?"#define EMISSIVEMAP_UV "+e.emissiveMapUv:"",e.bumpMapUv?"#define BUMPMAP_UV "+e.bumpMapUv:"",e.normalMapUv?"#define NORMALMAP_UV "+e.normalMapUv:"",e.displacementMapUv?"#define DISPLACEMENTMAP_UV "+e.displacementMapUv:"",e.metalnessMapUv?"#define METALNESSMAP_UV "+e.metalnessMapUv:"",e.roughnessMapUv?"#define ROUGHNESSMAP_UV "+e.roughnessMapUv:"",e.anisotropyMapUv?"#define ANISOTROPYMAP_UV "+e.anisotropyMapUv:"",e.clearcoatMapUv?"#define CLEARCOATMAP_UV "+e.clearcoatMapUv:"",e.clearcoatNormalMapUv?"#define CLEARCOAT_NORMALMAP_UV "+e.clearcoatNormalMapUv:"",e.clearcoatRoughnessMapUv?"#define CLEARCOAT_ROUGHNESSMAP_UV "+e.clearcoatRoughnessMapUv:"",e.diffuseRoughnessMapUv?"#define DIFFUSE_ROUGHNESSMAP_UV "+e.diffuseRoughnessMapUv:"",e.iridescenceMapUv?"#define IRIDESCENCEMAP_UV "+e.iridescenceMapUv:"",e.iridescenceThicknessMapUv?"#define IRIDESCENCE_THICKNESSMAP_UV "+e.iridescenceThicknessMapUv:"",e.sheenColorMapUv?"#define SHEEN_COLORMAP_UV "+e.sheenColorMapUv:"",e.sheenRoughnessMapUv?"#define SHEEN_ROUGHNESSMAP_UV "+e.sheenRoughnessMapUv:"",e.specularMapUv?"#define SPECULARMAP_UV "+e.specularMapUv:"",e.specularColorMapUv?"#define SPECULAR_COLORMAP_UV "+e.specularColorMapUv:"",e.specularIntensityMapUv?"#define SPECULAR_INTENSITYMAP_UV "+e.specularIntensityMapUv:"",e.transmissionMapUv?"#define TRANSMISSIONMAP_UV "+e.transmissionMapUv:"",e.thicknessMapUv?"#define THICKNESSMAP_UV "+e.thicknessMapUv:"",e.vertexTangents&&e.flatShading===!1?"#define USE_TANGENT":"",e.vertexNormals?"#define HAS_NORMAL":"",e.vertexColors?"#define USE_COLOR":"",e.vertexAlphas?"#define USE_COLOR_ALPHA":"",e.vertexUv1s?"#define USE_UV1":"",e.vertexUv2s?"#define USE_UV2":"",e.vertexUv3s?"#define USE_UV3":"",e.pointsUvs?"#define USE_POINTS_UV":"",e.flatShading?"#define FLAT_SHADED":"",e.skinning?"#define USE_SKINNING":"",e.morphTargets?"#define USE_MORPHTARGETS":"",e.morphNormals&&e.flatShading===!1?"#define USE_MORPHNORMALS":"",e.morphColors?"#define USE_MORPHCOLORS":"",e.morphTargetsCount>0?"#define MORPHTARGETS_TEXTURE_STRIDE "+e.morphTextureStride:"",e.morphTargetsCount>0?"#define MORPHTARGETS_COUNT "+e.morphTargetsCount:"",e.doubleSided?"#define DOUBLE_SIDED":"",e.flipSided?"#define FLIP_SIDED":"",e.shadowMapEnabled?"#define USE_SHADOWMAP":"",e.shadowMapEnabled?"#define "+a:"",e.sizeAttenuation?"#define USE_SIZEATTENUATION":"",e.numLightProbes>0?"#define USE_LIGHT_PROBES":"",e.logarithmicDepthBuffer?"#define USE_LOGARITHMIC_DEPTH_BUFFER":"",e.reversedDepthBuffer?"#define USE_REVERSED_DEPTH_BUFFER":"","uniform mat4 modelMatrix;","uniform mat4 modelViewMatrix;","uniform mat4 projectionMatrix;","uniform mat4 viewMatrix;","uniform mat3 normalMatrix;","uniform vec3 cameraPosition;","uniform bool isOrthographic;","#ifdef USE_INSTANCING","	attribute mat4 instanceMatrix;","#endif","#ifdef USE_INSTANCING_COLOR","	attribute vec3 instanceColor;","#endif","#ifdef USE_INSTANCING_MORPH","	uniform sampler2D morphTexture;","#endif","attribute vec3 position;","attribute vec3 normal;","attribute vec2 uv;","#ifdef USE_UV1","	attribute vec2 uv1;","#endif","#ifdef USE_UV2","	attribute vec2 uv2;","#endif","#ifdef USE_UV3","	attribute vec2 uv3;","#endif","#ifdef USE_TANGENT","	attribute vec4 tangent;","#endif","#if defined( USE_COLOR_ALPHA )","	attribute vec4 color;","#elif defined( USE_COLOR )","	attribute vec3 color;","#endif","#ifdef USE_SKINNING","	attribute vec4 skinIndex;","	attribute vec4 skinWeight;","#endif",`
`].filter(ro).join(`
`),p=[rp(e),"#define SHADER_TYPE "+e.shaderType,"#define SHADER_NAME "+e.shaderName,d,e.useFog&&e.fog?"#define USE_FOG":"",e.useFog&&e.fogExp2?"#define FOG_EXP2":"",e.alphaToCoverage?"#define ALPHA_TO_COVERAGE":"",e.map?"#define USE_MAP":"",e.matcap?"#define USE_MATCAP":"",e.envMap?"#define USE_ENVMAP":"",e.envMap?"#define "+c:"",e.envMap?"#define "+u:"",e.envMap?"#define "+h:"",e.envMapPMREM?"#define ENVMAP_MAX_LOD "+e.envMapMaxLod+".0":"",e.envMapPMREM?"#define ENVMAP_SIZE "+e.envMapSize+".0":"",e.lightMap?"#define USE_LIGHTMAP":"",e.aoMap?"#define USE_AOMAP":"",e.bumpMap?"#define USE_BUMPMAP":"",e.normalMap?"#define USE_NORMALMAP":"",e.normalMapObjectSpace?"#define USE_NORMALMAP_OBJECTSPACE":"",e.normalMapTangentSpace?"#define USE_NORMALMAP_TANGENTSPACE":"",e.packedNormalMap?"#define USE_PACKED_NORMALMAP":"",e.emissiveMap?"#define USE_EMISSIVEMAP":"",e.anisotropy?"#define USE_ANISOTROPY":"",e.anisotropyMap?"#define USE_ANISOTROPYMAP":"",e.clearcoat?"#define USE_CLEARCOAT":"",e.clearcoatMap?"#define USE_CLEARCOATMAP":"",e.clearcoatRoughnessMap?"#define USE_CLEARCOAT_ROUGHNESSMAP":"",e.clearcoatNormalMap?"#define USE_CLEARCOAT_NORMALMAP":"",e.diffuseRoughness?"#define USE_DIFFUSE_ROUGHNESS":"",e.diffuseRoughnessMap?"#define USE_DIFFUSE_ROUGHNESSMAP":"",e.dispersion?"#define USE_DISPERSION":"",e.retroreflection?"#define USE_RETROREFLECTION":"",e.iridescence?"#define USE_IRIDESCENCE":"",e.iridescenceMap?"#define USE_IRIDESCENCEMAP":"",e.iridescenceThicknessMap?"#define USE_IRIDESCENCE_THICKNESSMAP":"",e.specularMap?"#define USE_SPECULARMAP":"",e.specularColorMap?"#define USE_SPECULAR_COLORMAP":"",e.specularIntensityMap?"#define USE_SPECULAR_INTENSITYMAP":"",e.roughnessMap?"#define USE_ROUGHNESSMAP":"",e.metalnessMap?"#define USE_METALNESSMAP":"",e.alphaMap?"#define USE_ALPHAMAP":"",e.alphaTest?"#define USE_ALPHATEST":"",e.alphaHash?"#define USE_ALPHAHASH":"",e.sheen?"#define USE_SHEEN":"",e.sheenColorMap?"#define USE_SHEEN_COLORMAP":"",e.sheenRoughnessMap?"#define USE_SHEEN_ROUGHNESSMAP":"",e.transmission?"#define USE_TRANSMISSION":"",e.transmissionMap?"#define USE_TRANSMISSIONMAP":"",e.thicknessMap?"#define USE_THICKNESSMAP":"",e.vertexTangents&&e.flatShading===!1?"#define USE_TANGENT":"",e.vertexColors||e.instancingColor?"#define USE_COLOR":"",e.vertexAlphas||e.batchingColor?"#define USE_COLOR_ALPHA":"",e.vertexUv1s?"#define USE_UV1":"",e.vertexUv2s?"#define USE_UV2":"",e.vertexUv3s?"#define USE_UV3":"",e.pointsUvs?"#define USE_POINTS_UV":"",e.gradientMap?"#define USE_GRADIENTMAP":"",e.flatShading?"#define FLAT_SHADED":"",e.doubleSided?"#define DOUBLE_SIDED":"",e.flipSided?"#define FLIP_SIDED":"",e.shadowMapEnabled?"#define USE_SHADOWMAP":"",e.shadowMapEnabled?"#define "+a:"",e.premultipliedAlpha?"#define PREMULTIPLIED_ALPHA":"",e.numLightProbes>0?"#define USE_LIGHT_PROBES":"",e.decodeVideoTexture?"#define DECODE_VIDEO_TEXTURE":"",e.decodeVideoTextureEmissive?"#define DECODE_VIDEO_TEXTURE_EMISSIVE":"",e.logarithmicDepthBuffer?"#define USE_LOGARITHMIC_DEPTH_BUFFER":"",e.reversedDepthBuffer?"#define USE_REVERSED_DEPTH_BUFFER":"","uniform mat4 viewMatrix;","uniform vec3 cameraPosition;","uniform bool isOrthographic;",e.toneMapping!==Qn?"#define TONE_MAPPING":"",e.toneMapping!==Qn?Gt.tonemapping_pars_fragment:"",e.toneMapping!==Qn?ev("toneMapping",e.toneMapping):"",e.dithering?"#define DITHERING":"",e.opaque?"#define OPAQUE":"",Gt.colorspace_pars_fragment,jy("linearToOutputTexel",e.outputColorSpace),nv(),e.useDepthPacking?"#define DEPTH_PACKING "+e.depthPacking:"",`
`].filter(ro).join(`
`)),o=sh(o),o=np(o,e),o=ip(o,e),l=sh(l),l=np(l,e),l=ip(l,e),o=sp(o),l=sp(l),e.isRawShaderMaterial!==!0&&(m=`#version 300 es
`,y=[f,"#define attribute in","#define varying out","#define texture2D texture"].join(`
`)+`
`+y,p=["#define varying in",e.glslVersion===bi?"":"layout(location = 0) out highp vec4 pc_fragColor;",e.glslVersion===bi?"":"#define gl_FragColor pc_fragColor","#define gl_FragDepthEXT gl_FragDepth","#define texture2D texture","#define textureCube texture","#define texture2DProj textureProj","#define texture2DLodEXT textureLod","#define texture2DProjLodEXT textureProjLod","#define textureCubeLodEXT textureLod","#define texture2DGradEXT textureGrad","#define texture2DProjGradEXT textureProjGrad","#define textureCubeGradEXT textureGrad"].join(`
`)+`
`+p);let x=m+y+o,M=m+p+l,v=jd(s,s.VERTEX_SHADER,x),S=jd(s,s.FRAGMENT_SHADER,M);s.attachShader(g,v),s.attachShader(g,S),e.index0AttributeName!==void 0?s.bindAttribLocation(g,0,e.index0AttributeName):e.hasPositionAttribute===!0&&s.bindAttribLocation(g,0,"position"),s.linkProgram(g);function A(E){if(i.debug.checkShaderErrors){let C=s.getProgramInfoLog(g)||"",I=s.getShaderInfoLog(v)||"",U=s.getShaderInfoLog(S)||"",P=C.trim(),B=I.trim(),H=U.trim(),G=!0,et=!0;if(s.getProgramParameter(g,s.LINK_STATUS)===!1)if(G=!1,typeof i.debug.onShaderError=="function")i.debug.onShaderError(s,g,v,S);else{let X=ep(s,v,"vertex"),j=ep(s,S,"fragment");Lt("WebGLProgram: Shader Error "+s.getError()+" - VALIDATE_STATUS "+s.getProgramParameter(g,s.VALIDATE_STATUS)+`

Material Name: `+E.name+`
Material Type: `+E.type+`

Program Info Log: `+P+`
`+X+`
`+j)}else P!==""?Rt("WebGLProgram: Program Info Log:",P):(B===""||H==="")&&(et=!1);et&&(E.diagnostics={runnable:G,programLog:P,vertexShader:{log:B,prefix:y},fragmentShader:{log:H,prefix:p}})}s.deleteShader(v),s.deleteShader(S),_=new js(s,g),b=rv(s,g)}let _;this.getUniforms=function(){return _===void 0&&A(this),_};let b;this.getAttributes=function(){return b===void 0&&A(this),b};let L=e.rendererExtensionParallelShaderCompile===!1;return this.isReady=function(){return L===!1&&(L=s.getProgramParameter(g,Zy)),L},this.destroy=function(){n.releaseStatesOfProgram(this),s.deleteProgram(g),this.program=void 0},this.type=e.shaderType,this.name=e.shaderName,this.id=Jy++,this.cacheKey=t,this.usedTimes=1,this.program=g,this.vertexShader=v,this.fragmentShader=S,this}var xv=0,rh=class{constructor(){this.shaderCache=new Map,this.materialCache=new Map}update(t,e,n){let s=this._getShaderCacheForMaterial(t);return s.has(e)===!1&&(s.add(e),e.usedTimes++),s.has(n)===!1&&(s.add(n),n.usedTimes++),this}remove(t){let e=this.materialCache.get(t);for(let n of e)n.usedTimes--,n.usedTimes===0&&this.shaderCache.delete(n.code);return this.materialCache.delete(t),this}getVertexShaderStage(t){return this._getShaderStage(t.vertexShader)}getFragmentShaderStage(t){return this._getShaderStage(t.fragmentShader)}dispose(){this.shaderCache.clear(),this.materialCache.clear()}_getShaderCacheForMaterial(t){let e=this.materialCache,n=e.get(t);return n===void 0&&(n=new Set,e.set(t,n)),n}_getShaderStage(t){let e=this.shaderCache,n=e.get(t);return n===void 0&&(n=new oh(t),e.set(t,n)),n}},oh=class{constructor(t){this.id=xv++,this.code=t,this.usedTimes=0}};function _v(i){return i===Hi||i===to||i===eo}function yv(i,t,e,n,s,r){let o=new Ws,l=new rh,a=new Set,c=[],u=new Map,h=n.logarithmicDepthBuffer,f={MeshDepthMaterial:"depth",MeshDistanceMaterial:"distance",MeshNormalMaterial:"normal",MeshBasicMaterial:"basic",MeshLambertMaterial:"lambert",MeshPhongMaterial:"phong",MeshToonMaterial:"toon",MeshStandardMaterial:"physical",MeshPhysicalMaterial:"physical",MeshMatcapMaterial:"matcap",LineBasicMaterial:"basic",LineDashedMaterial:"dashed",PointsMaterial:"points",ShadowMaterial:"shadow",SpriteMaterial:"sprite"};function d(_){return a.add(_),_===0?"uv":`uv${_}`}function g(_,b,L,E,C,I){let U=E.fog,P=C.geometry,B=_.isMeshStandardMaterial||_.isMeshLambertMaterial||_.isMeshPhongMaterial?E.environment:null,H=_.isMeshStandardMaterial||_.isMeshLambertMaterial&&!_.envMap||_.isMeshPhongMaterial&&!_.envMap,G=t.get(_.envMap||B,H),et=f[_.type],X=n.precision;_.precision!==null&&(X=n.getMaxPrecision(_.precision),X!==_.precision&&Rt("WebGLProgram.getParameters:",_.precision,"not supported, using",X,"instead."));let j=P.morphAttributes.position||P.morphAttributes.normal||P.morphAttributes.color,tt=j!==void 0?j.length:0,yt=0;P.morphAttributes.position!==void 0&&(yt=1),P.morphAttributes.normal!==void 0&&(yt=2),P.morphAttributes.color!==void 0&&(yt=3);let Nt,J,ut,_t;if(et){let mt=ti[et];Nt=mt.vertexShader,J=mt.fragmentShader}else{Nt=_.vertexShader,J=_.fragmentShader;let mt=l.getVertexShaderStage(_),se=l.getFragmentShaderStage(_);l.update(_,mt,se),ut=mt.id,_t=se.id}let Tt=i.getRenderTarget(),pt=i.state.buffers.depth.getReversed(),Ut=C.isInstancedMesh===!0,Se=C.isBatchedMesh===!0,Ct=!!_.map,Kt=!!_.matcap,ae=!!G,Wt=ae&&G.isPMREMTexture===!0,Ve=!!_.aoMap,Pe=!!_.lightMap,un=!!_.bumpMap&&_.wireframe===!1,ve=!!_.normalMap,Yn=!!_.displacementMap,Fe=!!_.emissiveMap,wn=!!_.metalnessMap,An=!!_.roughnessMap,Tn=_.anisotropy>0,O=_.clearcoat>0,En=_.diffuseRoughness>0,ge=_.dispersion>0,xe=_.retroreflectivity>0,dt=_.iridescence>0,Ie=_.sheen>0,Pt=_.transmission>0,Ft=Tn&&!!_.anisotropyMap,R=O&&!!_.clearcoatMap,w=O&&!!_.clearcoatNormalMap,k=O&&!!_.clearcoatRoughnessMap,nt=En&&!!_.diffuseRoughnessMap,Q=dt&&!!_.iridescenceMap,rt=dt&&!!_.iridescenceThicknessMap,ht=Ie&&!!_.sheenColorMap,$=Ie&&!!_.sheenRoughnessMap,Z=!!_.specularMap,at=!!_.specularColorMap,D=!!_.specularIntensityMap,K=Pt&&!!_.transmissionMap,q=Pt&&!!_.thicknessMap,lt=!!_.gradientMap,st=!!_.alphaMap,ot=_.alphaTest>0,wt=!!_.alphaHash,Vt=!!_.extensions,it=Qn;_.toneMapped&&(Tt===null||Tt.isXRRenderTarget===!0)&&(it=i.toneMapping);let At=Wt?G.isCompressedCubeTexture?G.image[0].mipmaps:G.mipmaps:null,kt={shaderID:et,shaderType:_.type,shaderName:_.name,vertexShader:Nt,fragmentShader:J,defines:_.defines,customVertexShaderID:ut,customFragmentShaderID:_t,isRawShaderMaterial:_.isRawShaderMaterial===!0,glslVersion:_.glslVersion,precision:X,batching:Se,batchingColor:Se&&C._colorsTexture!==null,instancing:Ut,instancingColor:Ut&&C.instanceColor!==null,instancingMorph:Ut&&C.morphTexture!==null,outputColorSpace:Tt===null?i.outputColorSpace:Tt.isXRRenderTarget===!0?Tt.texture.colorSpace:Yt.workingColorSpace,alphaToCoverage:!!_.alphaToCoverage,map:Ct,matcap:Kt,envMap:ae,envMapMode:ae&&G.mapping,envMapPMREM:Wt,envMapMaxLod:Wt?At.length-1:null,envMapSize:Wt?At[0].width:null,aoMap:Ve,lightMap:Pe,bumpMap:un,normalMap:ve,displacementMap:Yn,emissiveMap:Fe,normalMapObjectSpace:ve&&_.normalMapType===Ed,normalMapTangentSpace:ve&&_.normalMapType===Vu,packedNormalMap:ve&&_.normalMapType===Vu&&_v(_.normalMap.format),metalnessMap:wn,roughnessMap:An,anisotropy:Tn,anisotropyMap:Ft,clearcoat:O,clearcoatMap:R,clearcoatNormalMap:w,clearcoatRoughnessMap:k,diffuseRoughness:En,diffuseRoughnessMap:nt,dispersion:ge,retroreflection:xe,iridescence:dt,iridescenceMap:Q,iridescenceThicknessMap:rt,sheen:Ie,sheenColorMap:ht,sheenRoughnessMap:$,specularMap:Z,specularColorMap:at,specularIntensityMap:D,transmission:Pt,transmissionMap:K,thicknessMap:q,gradientMap:lt,opaque:_.transparent===!1&&_.blending===Js&&_.alphaToCoverage===!1,alphaMap:st,alphaTest:ot,alphaHash:wt,combine:_.combine,mapUv:Ct&&d(_.map.channel),aoMapUv:Ve&&d(_.aoMap.channel),lightMapUv:Pe&&d(_.lightMap.channel),bumpMapUv:un&&d(_.bumpMap.channel),normalMapUv:ve&&d(_.normalMap.channel),displacementMapUv:Yn&&d(_.displacementMap.channel),emissiveMapUv:Fe&&d(_.emissiveMap.channel),metalnessMapUv:wn&&d(_.metalnessMap.channel),roughnessMapUv:An&&d(_.roughnessMap.channel),anisotropyMapUv:Ft&&d(_.anisotropyMap.channel),clearcoatMapUv:R&&d(_.clearcoatMap.channel),clearcoatNormalMapUv:w&&d(_.clearcoatNormalMap.channel),clearcoatRoughnessMapUv:k&&d(_.clearcoatRoughnessMap.channel),diffuseRoughnessMapUv:nt&&d(_.diffuseRoughnessMap.channel),iridescenceMapUv:Q&&d(_.iridescenceMap.channel),iridescenceThicknessMapUv:rt&&d(_.iridescenceThicknessMap.channel),sheenColorMapUv:ht&&d(_.sheenColorMap.channel),sheenRoughnessMapUv:$&&d(_.sheenRoughnessMap.channel),specularMapUv:Z&&d(_.specularMap.channel),specularColorMapUv:at&&d(_.specularColorMap.channel),specularIntensityMapUv:D&&d(_.specularIntensityMap.channel),transmissionMapUv:K&&d(_.transmissionMap.channel),thicknessMapUv:q&&d(_.thicknessMap.channel),alphaMapUv:st&&d(_.alphaMap.channel),vertexTangents:!!P.attributes.tangent&&(ve||Tn),vertexNormals:!!P.attributes.normal,vertexColors:_.vertexColors,vertexAlphas:_.vertexColors===!0&&!!P.attributes.color&&P.attributes.color.itemSize===4,pointsUvs:C.isPoints===!0&&!!P.attributes.uv&&(Ct||st),fog:!!U,useFog:_.fog===!0,fogExp2:!!U&&U.isFogExp2,flatShading:_.wireframe===!1&&(_.flatShading===!0||P.attributes.normal===void 0&&ve===!1&&(_.isMeshLambertMaterial||_.isMeshPhongMaterial||_.isMeshStandardMaterial||_.isMeshPhysicalMaterial)),sizeAttenuation:_.sizeAttenuation===!0,logarithmicDepthBuffer:h,reversedDepthBuffer:pt,skinning:C.isSkinnedMesh===!0,hasPositionAttribute:P.attributes.position!==void 0,morphTargets:P.morphAttributes.position!==void 0,morphNormals:P.morphAttributes.normal!==void 0,morphColors:P.morphAttributes.color!==void 0,morphTargetsCount:tt,morphTextureStride:yt,numSunLights:b.sun.length,numDirLights:b.directional.length,numPointLights:b.point.length,numSpotLights:b.spot.length,numSpotLightMaps:b.spotLightMap.length,numRectAreaLights:b.rectArea.length,numHemiLights:b.hemi.length,numSunLightShadows:b.sunShadowMap.length,numDirLightShadows:b.directionalShadowMap.length,numPointLightShadows:b.pointShadowMap.length,numSpotLightShadows:b.spotShadowMap.length,numSpotLightShadowsWithMaps:b.numSpotLightShadowsWithMaps,numLightProbes:b.numLightProbes,numLightProbeGrids:I.filter(mt=>mt.texture!==null).length,numClippingPlanes:r.numPlanes,numClipIntersection:r.numIntersection,dithering:_.dithering,shadowMapEnabled:i.shadowMap.enabled&&L.length>0,shadowMapType:i.shadowMap.type,toneMapping:it,decodeVideoTexture:Ct&&_.map.isVideoTexture===!0&&Yt.getTransfer(_.map.colorSpace)===ne,decodeVideoTextureEmissive:Fe&&_.emissiveMap.isVideoTexture===!0&&Yt.getTransfer(_.emissiveMap.colorSpace)===ne,premultipliedAlpha:_.premultipliedAlpha,doubleSided:_.side===ye,flipSided:_.side===qe,useDepthPacking:_.depthPacking>=0,depthPacking:_.depthPacking||0,index0AttributeName:_.index0AttributeName,extensionClipCullDistance:Vt&&_.extensions.clipCullDistance===!0&&e.has("WEBGL_clip_cull_distance"),extensionMultiDraw:(Vt&&_.extensions.multiDraw===!0||Se)&&e.has("WEBGL_multi_draw"),rendererExtensionParallelShaderCompile:e.has("KHR_parallel_shader_compile"),customProgramCacheKey:_.customProgramCacheKey()};return kt.vertexUv1s=a.has(1),kt.vertexUv2s=a.has(2),kt.vertexUv3s=a.has(3),a.clear(),kt}function y(_){let b=[];if(_.shaderID?b.push(_.shaderID):(b.push(_.customVertexShaderID),b.push(_.customFragmentShaderID)),_.defines!==void 0)for(let L in _.defines)b.push(L),b.push(_.defines[L]);return _.isRawShaderMaterial===!1&&(p(b,_),m(b,_),b.push(i.outputColorSpace)),b.push(_.customProgramCacheKey),b.join()}function p(_,b){_.push(b.precision),_.push(b.outputColorSpace),_.push(b.envMapMode),_.push(b.envMapPMREM),_.push(b.envMapMaxLod),_.push(b.envMapSize),_.push(b.mapUv),_.push(b.alphaMapUv),_.push(b.lightMapUv),_.push(b.aoMapUv),_.push(b.bumpMapUv),_.push(b.normalMapUv),_.push(b.displacementMapUv),_.push(b.emissiveMapUv),_.push(b.metalnessMapUv),_.push(b.roughnessMapUv),_.push(b.anisotropyMapUv),_.push(b.clearcoatMapUv),_.push(b.clearcoatNormalMapUv),_.push(b.clearcoatRoughnessMapUv),_.push(b.diffuseRoughnessMapUv),_.push(b.iridescenceMapUv),_.push(b.iridescenceThicknessMapUv),_.push(b.sheenColorMapUv),_.push(b.sheenRoughnessMapUv),_.push(b.specularMapUv),_.push(b.specularColorMapUv),_.push(b.specularIntensityMapUv),_.push(b.transmissionMapUv),_.push(b.thicknessMapUv),_.push(b.combine),_.push(b.fogExp2),_.push(b.sizeAttenuation),_.push(b.morphTargetsCount),_.push(b.numSunLights),_.push(b.numDirLights),_.push(b.numPointLights),_.push(b.numSpotLights),_.push(b.numSpotLightMaps),_.push(b.numHemiLights),_.push(b.numRectAreaLights),_.push(b.numSunLightShadows),_.push(b.numDirLightShadows),_.push(b.numPointLightShadows),_.push(b.numSpotLightShadows),_.push(b.numSpotLightShadowsWithMaps),_.push(b.numLightProbes),_.push(b.numLightProbeGrids),_.push(b.shadowMapType),_.push(b.toneMapping),_.push(b.numClippingPlanes),_.push(b.numClipIntersection),_.push(b.depthPacking)}function m(_,b){o.disableAll(),b.instancing&&o.enable(0),b.instancingColor&&o.enable(1),b.instancingMorph&&o.enable(2),b.matcap&&o.enable(3),b.envMap&&o.enable(4),b.normalMapObjectSpace&&o.enable(5),b.normalMapTangentSpace&&o.enable(6),b.clearcoat&&o.enable(7),b.iridescence&&o.enable(8),b.alphaTest&&o.enable(9),b.vertexColors&&o.enable(10),b.vertexAlphas&&o.enable(11),b.vertexUv1s&&o.enable(12),b.vertexUv2s&&o.enable(13),b.vertexUv3s&&o.enable(14),b.vertexTangents&&o.enable(15),b.anisotropy&&o.enable(16),b.alphaHash&&o.enable(17),b.batching&&o.enable(18),b.dispersion&&o.enable(19),b.retroreflection&&o.enable(24),b.diffuseRoughness&&o.enable(25),b.batchingColor&&o.enable(20),b.gradientMap&&o.enable(21),b.packedNormalMap&&o.enable(22),b.vertexNormals&&o.enable(23),_.push(o.mask),o.disableAll(),b.fog&&o.enable(0),b.useFog&&o.enable(1),b.flatShading&&o.enable(2),b.logarithmicDepthBuffer&&o.enable(3),b.reversedDepthBuffer&&o.enable(4),b.skinning&&o.enable(5),b.morphTargets&&o.enable(6),b.morphNormals&&o.enable(7),b.morphColors&&o.enable(8),b.premultipliedAlpha&&o.enable(9),b.shadowMapEnabled&&o.enable(10),b.doubleSided&&o.enable(11),b.flipSided&&o.enable(12),b.useDepthPacking&&o.enable(13),b.dithering&&o.enable(14),b.transmission&&o.enable(15),b.sheen&&o.enable(16),b.opaque&&o.enable(17),b.pointsUvs&&o.enable(18),b.decodeVideoTexture&&o.enable(19),b.decodeVideoTextureEmissive&&o.enable(20),b.alphaToCoverage&&o.enable(21),b.numLightProbeGrids>0&&o.enable(22),b.hasPositionAttribute&&o.enable(23),_.push(o.mask)}function x(_){let b=f[_.type],L;if(b){let E=ti[b];L=kd.clone(E.uniforms)}else L=_.uniforms;return L}function M(_,b){let L=u.get(b);return L!==void 0?++L.usedTimes:(L=new gv(i,b,_,s),c.push(L),u.set(b,L)),L}function v(_){if(--_.usedTimes===0){let b=c.indexOf(_);c[b]=c[c.length-1],c.pop(),u.delete(_.cacheKey),_.destroy()}}function S(_){l.remove(_)}function A(){l.dispose()}return{getParameters:g,getProgramCacheKey:y,getUniforms:x,acquireProgram:M,releaseProgram:v,releaseShaderCache:S,programs:c,dispose:A}}function vv(){let i=new WeakMap;function t(o){return i.has(o)}function e(o){let l=i.get(o);return l===void 0&&(l={},i.set(o,l)),l}function n(o){i.delete(o)}function s(o,l,a){i.get(o)[l]=a}function r(){i=new WeakMap}return{has:t,get:e,remove:n,update:s,dispose:r}}function Mv(i,t){return i.groupOrder!==t.groupOrder?i.groupOrder-t.groupOrder:i.renderOrder!==t.renderOrder?i.renderOrder-t.renderOrder:i.material.id!==t.material.id?i.material.id-t.material.id:i.materialVariant!==t.materialVariant?i.materialVariant-t.materialVariant:i.z!==t.z?i.z-t.z:i.id-t.id}function op(i,t){return i.groupOrder!==t.groupOrder?i.groupOrder-t.groupOrder:i.renderOrder!==t.renderOrder?i.renderOrder-t.renderOrder:i.z!==t.z?t.z-i.z:i.id-t.id}function ap(){let i=[],t=0,e=[],n=[],s=[];function r(){t=0,e.length=0,n.length=0,s.length=0}function o(f){let d=0;return f.isInstancedMesh&&(d+=2),f.isSkinnedMesh&&(d+=1),d}function l(f,d,g,y,p,m){let x=i[t];return x===void 0?(x={id:f.id,object:f,geometry:d,material:g,materialVariant:o(f),groupOrder:y,renderOrder:f.renderOrder,z:p,group:m},i[t]=x):(x.id=f.id,x.object=f,x.geometry=d,x.material=g,x.materialVariant=o(f),x.groupOrder=y,x.renderOrder=f.renderOrder,x.z=p,x.group=m),t++,x}function a(f,d,g,y,p,m,x){x.reversedDepth===!0&&(p=-p);let M=l(f,d,g,y,p,m);g.transmission>0?n.push(M):g.transparent===!0?s.push(M):e.push(M)}function c(f,d,g,y,p,m){let x=l(f,d,g,y,p,m);g.transmission>0?n.unshift(x):g.transparent===!0?s.unshift(x):e.unshift(x)}function u(f,d){e.length>1&&e.sort(f||Mv),n.length>1&&n.sort(d||op),s.length>1&&s.sort(d||op)}function h(){for(let f=t,d=i.length;f<d;f++){let g=i[f];if(g.id===null)break;g.id=null,g.object=null,g.geometry=null,g.material=null,g.group=null}}return{opaque:e,transmissive:n,transparent:s,init:r,push:a,unshift:c,finish:h,sort:u}}function Sv(){let i=new WeakMap;function t(n,s){let r=i.get(n),o;return r===void 0?(o=new ap,i.set(n,[o])):s>=r.length?(o=new ap,r.push(o)):o=r[s],o}function e(){i=new WeakMap}return{get:t,dispose:e}}function bv(){let i={};return{get:function(t){if(i[t.id]!==void 0)return i[t.id];let e;switch(t.type){case"SunLight":case"DirectionalLight":e={direction:new N,color:new Zt};break;case"SpotLight":e={position:new N,direction:new N,color:new Zt,distance:0,coneCos:0,penumbraCos:0,decay:0};break;case"PointLight":e={position:new N,color:new Zt,distance:0,decay:0};break;case"HemisphereLight":e={direction:new N,skyColor:new Zt,groundColor:new Zt};break;case"RectAreaLight":e={color:new Zt,position:new N,halfWidth:new N,halfHeight:new N};break}return i[t.id]=e,e}}}function wv(){let i={};return{get:function(t){if(i[t.id]!==void 0)return i[t.id];let e;switch(t.type){case"SunLight":case"DirectionalLight":e={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new Et};break;case"SpotLight":e={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new Et};break;case"PointLight":e={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new Et,shadowCameraNear:1,shadowCameraFar:1e3};break}return i[t.id]=e,e}}}var Av=0;function Tv(i,t){return(t.castShadow?2:0)-(i.castShadow?2:0)+(t.map?1:0)-(i.map?1:0)}function Ev(i){let t=new bv,e=wv(),n={version:0,hash:{sunLength:-1,directionalLength:-1,pointLength:-1,spotLength:-1,rectAreaLength:-1,hemiLength:-1,numSunShadows:-1,numDirectionalShadows:-1,numPointShadows:-1,numSpotShadows:-1,numSpotMaps:-1,numLightProbes:-1},ambient:[0,0,0],probe:[],sun:[],sunShadow:[],sunShadowMap:[],sunShadowMatrix:[],sunShadowCascade:[],directional:[],directionalShadow:[],directionalShadowMap:[],directionalShadowMatrix:[],spot:[],spotLightMap:[],spotShadow:[],spotShadowMap:[],spotLightMatrix:[],rectArea:[],rectAreaLTC1:null,rectAreaLTC2:null,point:[],pointShadow:[],pointShadowMap:[],pointShadowMatrix:[],hemi:[],numSpotLightShadowsWithMaps:0,numLightProbes:0};for(let c=0;c<9;c++)n.probe.push(new N);let s=new N,r=new zt,o=new zt;function l(c){let u=0,h=0,f=0;for(let I=0;I<9;I++)n.probe[I].set(0,0,0);let d=0,g=0,y=0,p=0,m=0,x=0,M=0,v=0,S=0,A=0,_=0,b=0,L=0,E=0;c.sort(Tv);for(let I=0,U=c.length;I<U;I++){let P=c[I],B=P.color,H=P.intensity,G=P.distance,et=null;if(P.shadow&&P.shadow.map&&(P.shadow.map.texture.format===Hi?et=P.shadow.map.texture:et=P.shadow.map.depthTexture||P.shadow.map.texture),P.isAmbientLight)u+=B.r*H,h+=B.g*H,f+=B.b*H;else if(P.isLightProbe){for(let X=0;X<9;X++)n.probe[X].addScaledVector(P.sh.coefficients[X],H);E++}else if(P.isSunLight){let X=t.get(P);if(X.color.copy(P.color).multiplyScalar(P.intensity),P.castShadow){let j=P.shadow,tt=e.get(P);tt.shadowIntensity=j.intensity,tt.shadowBias=j.bias,tt.shadowNormalBias=j.normalBias,tt.shadowRadius=j.radius,tt.shadowMapSize.copy(j.mapSize).multiply(j.getFrameExtents()),n.sunShadow[g]=tt,n.sunShadowMap[g]=et;let yt=j.getViewportCount();for(let Nt=0;Nt<yt;Nt++)n.sunShadowMatrix[y+Nt]=j.getMatrix(Nt),n.sunShadowCascade[y+Nt]=j._cascadeData[Nt];y+=yt,g++}n.sun[d]=X,d++}else if(P.isDirectionalLight){let X=t.get(P);if(X.color.copy(P.color).multiplyScalar(P.intensity),P.castShadow){let j=P.shadow,tt=e.get(P);tt.shadowIntensity=j.intensity,tt.shadowBias=j.bias,tt.shadowNormalBias=j.normalBias,tt.shadowRadius=j.radius,tt.shadowMapSize=j.mapSize,n.directionalShadow[p]=tt,n.directionalShadowMap[p]=et,n.directionalShadowMatrix[p]=P.shadow.matrix,S++}n.directional[p]=X,p++}else if(P.isSpotLight){let X=t.get(P);X.position.setFromMatrixPosition(P.matrixWorld),X.color.copy(B).multiplyScalar(H),X.distance=G,X.coneCos=Math.cos(P.angle),X.penumbraCos=Math.cos(P.angle*(1-P.penumbra)),X.decay=P.decay,n.spot[x]=X;let j=P.shadow;if(P.map&&(n.spotLightMap[b]=P.map,b++,j.updateMatrices(P),P.castShadow&&L++),n.spotLightMatrix[x]=j.matrix,P.castShadow){let tt=e.get(P);tt.shadowIntensity=j.intensity,tt.shadowBias=j.bias,tt.shadowNormalBias=j.normalBias,tt.shadowRadius=j.radius,tt.shadowMapSize=j.mapSize,n.spotShadow[x]=tt,n.spotShadowMap[x]=et,_++}x++}else if(P.isRectAreaLight){let X=t.get(P);X.color.copy(B).multiplyScalar(H),X.halfWidth.set(P.width*.5,0,0),X.halfHeight.set(0,P.height*.5,0),n.rectArea[M]=X,M++}else if(P.isPointLight){let X=t.get(P);if(X.color.copy(P.color).multiplyScalar(P.intensity),X.distance=P.distance,X.decay=P.decay,P.castShadow){let j=P.shadow,tt=e.get(P);tt.shadowIntensity=j.intensity,tt.shadowBias=j.bias,tt.shadowNormalBias=j.normalBias,tt.shadowRadius=j.radius,tt.shadowMapSize=j.mapSize,tt.shadowCameraNear=j.camera.near,tt.shadowCameraFar=j.camera.far,n.pointShadow[m]=tt,n.pointShadowMap[m]=et,n.pointShadowMatrix[m]=P.shadow.matrix,A++}n.point[m]=X,m++}else if(P.isHemisphereLight){let X=t.get(P);X.skyColor.copy(P.color).multiplyScalar(H),X.groundColor.copy(P.groundColor).multiplyScalar(H),n.hemi[v]=X,v++}}M>0&&(i.has("OES_texture_float_linear")===!0?(n.rectAreaLTC1=gt.LTC_FLOAT_1,n.rectAreaLTC2=gt.LTC_FLOAT_2):(n.rectAreaLTC1=gt.LTC_HALF_1,n.rectAreaLTC2=gt.LTC_HALF_2)),n.ambient[0]=u,n.ambient[1]=h,n.ambient[2]=f;let C=n.hash;(C.sunLength!==d||C.directionalLength!==p||C.pointLength!==m||C.spotLength!==x||C.rectAreaLength!==M||C.hemiLength!==v||C.numSunShadows!==g||C.numDirectionalShadows!==S||C.numPointShadows!==A||C.numSpotShadows!==_||C.numSpotMaps!==b||C.numLightProbes!==E)&&(n.sun.length=d,n.directional.length=p,n.spot.length=x,n.rectArea.length=M,n.point.length=m,n.hemi.length=v,n.sunShadow.length=g,n.sunShadowMap.length=g,n.sunShadowMatrix.length=y,n.sunShadowCascade.length=y,n.directionalShadow.length=S,n.directionalShadowMap.length=S,n.directionalShadowMatrix.length=S,n.pointShadow.length=A,n.pointShadowMap.length=A,n.pointShadowMatrix.length=A,n.spotShadow.length=_,n.spotShadowMap.length=_,n.spotLightMatrix.length=_+b-L,n.spotLightMap.length=b,n.numSpotLightShadowsWithMaps=L,n.numLightProbes=E,C.sunLength=d,C.directionalLength=p,C.pointLength=m,C.spotLength=x,C.rectAreaLength=M,C.hemiLength=v,C.numSunShadows=g,C.numDirectionalShadows=S,C.numPointShadows=A,C.numSpotShadows=_,C.numSpotMaps=b,C.numLightProbes=E,n.version=Av++)}function a(c,u){let h=0,f=0,d=0,g=0,y=0,p=0,m=u.matrixWorldInverse;for(let x=0,M=c.length;x<M;x++){let v=c[x];if(v.isSunLight){let S=n.sun[h];S.direction.setFromMatrixPosition(v.matrixWorld),S.direction.transformDirection(m),h++}else if(v.isDirectionalLight){let S=n.directional[f];S.direction.setFromMatrixPosition(v.matrixWorld),s.setFromMatrixPosition(v.target.matrixWorld),S.direction.sub(s),S.direction.transformDirection(m),f++}else if(v.isSpotLight){let S=n.spot[g];S.position.setFromMatrixPosition(v.matrixWorld),S.position.applyMatrix4(m),S.direction.setFromMatrixPosition(v.matrixWorld),s.setFromMatrixPosition(v.target.matrixWorld),S.direction.sub(s),S.direction.transformDirection(m),g++}else if(v.isRectAreaLight){let S=n.rectArea[y];S.position.setFromMatrixPosition(v.matrixWorld),S.position.applyMatrix4(m),o.identity(),r.copy(v.matrixWorld),r.premultiply(m),o.extractRotation(r),S.halfWidth.set(v.width*.5,0,0),S.halfHeight.set(0,v.height*.5,0),S.halfWidth.applyMatrix4(o),S.halfHeight.applyMatrix4(o),y++}else if(v.isPointLight){let S=n.point[d];S.position.setFromMatrixPosition(v.matrixWorld),S.position.applyMatrix4(m),d++}else if(v.isHemisphereLight){let S=n.hemi[p];S.direction.setFromMatrixPosition(v.matrixWorld),S.direction.transformDirection(m),p++}}}return{setup:l,setupView:a,state:n}}function lp(i){let t=new Ev(i),e=[],n=[],s=[];function r(h){u.camera=h,e.length=0,n.length=0,s.length=0}function o(h){h.isLightProbeGrid?s.push(h):e.push(h)}function l(h){n.push(h)}function a(){t.setup(e),s.sort((h,f)=>h.priority-f.priority||h.id-f.id)}function c(h){t.setupView(e,h)}let u={lightsArray:e,shadowsArray:n,lightProbeGridArray:s,camera:null,lights:t,transmissionRenderTarget:{},textureUnits:0};return{init:r,state:u,setupLights:a,setupLightsView:c,pushLight:o,pushShadow:l}}function Rv(i){let t=new WeakMap;function e(s,r=0){let o=t.get(s),l;return o===void 0?(l=new lp(i),t.set(s,[l])):r>=o.length?(l=new lp(i),o.push(l)):l=o[r],l}function n(){t=new WeakMap}return{get:e,dispose:n}}var Cv=`void main() {
	gl_Position = vec4( position, 1.0 );
}`,Pv=`uniform sampler2D shadow_pass;
uniform vec2 resolution;
uniform float radius;
void main() {
	const float samples = float( VSM_SAMPLES );
	float mean = 0.0;
	float squared_mean = 0.0;
	float uvStride = samples <= 1.0 ? 0.0 : 2.0 / ( samples - 1.0 );
	float uvStart = samples <= 1.0 ? 0.0 : - 1.0;
	for ( float i = 0.0; i < samples; i ++ ) {
		float uvOffset = uvStart + i * uvStride;
		#ifdef HORIZONTAL_PASS
			vec2 distribution = texture2D( shadow_pass, ( gl_FragCoord.xy + vec2( uvOffset, 0.0 ) * radius ) / resolution ).rg;
			mean += distribution.x;
			squared_mean += distribution.y * distribution.y + distribution.x * distribution.x;
		#else
			float depth = texture2D( shadow_pass, ( gl_FragCoord.xy + vec2( 0.0, uvOffset ) * radius ) / resolution ).r;
			mean += depth;
			squared_mean += depth * depth;
		#endif
	}
	mean = mean / samples;
	squared_mean = squared_mean / samples;
	float std_dev = sqrt( max( 0.0, squared_mean - mean * mean ) );
	gl_FragColor = vec4( mean, std_dev, 0.0, 1.0 );
}`,Iv=[new N(1,0,0),new N(-1,0,0),new N(0,1,0),new N(0,-1,0),new N(0,0,1),new N(0,0,-1)],Lv=[new N(0,-1,0),new N(0,-1,0),new N(0,0,1),new N(0,0,-1),new N(0,-1,0),new N(0,-1,0)],cp=new zt,so=new N,th=new N;function Nv(i,t,e){let n=new us,s=new Et,r=new Et,o=new me,l=new Ea,a=new Ra,c={},u=e.maxTextureSize,h={[Vn]:qe,[qe]:Vn,[ye]:ye},f=new je({defines:{VSM_SAMPLES:8},uniforms:{shadow_pass:{value:null},resolution:{value:new Et},radius:{value:4}},vertexShader:Cv,fragmentShader:Pv}),d=f.clone();d.defines.HORIZONTAL_PASS=1;let g=new Xe;g.setAttribute("position",new Ae(new Float32Array([-1,-1,.5,3,-1,.5,-1,3,.5]),3));let y=new de(g,f),p=this;this.enabled=!1,this.autoUpdate=!0,this.needsUpdate=!1,this.type=$r;let m=this.type;this.render=function(A,_,b){if(p.enabled===!1||p.autoUpdate===!1&&p.needsUpdate===!1||A.length===0)return;this.type===sd&&(Rt("WebGLShadowMap: PCFSoftShadowMap has been removed. Using PCFShadowMap instead."),this.type=$r);let L=i.getRenderTarget(),E=i.getActiveCubeFace(),C=i.getActiveMipmapLevel(),I=i.state;I.setBlending(hs),I.buffers.depth.getReversed()===!0?I.buffers.color.setClear(0,0,0,0):I.buffers.color.setClear(1,1,1,1),I.buffers.depth.setTest(!0),I.setScissorTest(!1);let U=m!==this.type;U&&_.traverse(function(P){P.material&&(Array.isArray(P.material)?P.material.forEach(B=>B.needsUpdate=!0):P.material.needsUpdate=!0)});for(let P=0,B=A.length;P<B;P++){let H=A[P],G=H.shadow;if(G===void 0){Rt("WebGLShadowMap:",H,"has no shadow.");continue}if(G.autoUpdate===!1&&G.needsUpdate===!1)continue;s.copy(G.mapSize);let et=G.getFrameExtents();s.multiply(et),r.copy(G.mapSize),(s.x>u||s.y>u)&&(s.x>u&&(r.x=Math.floor(u/et.x),s.x=r.x*et.x,G.mapSize.x=r.x),s.y>u&&(r.y=Math.floor(u/et.y),s.y=r.y*et.y,G.mapSize.y=r.y));let X=i.state.buffers.depth.getReversed();if(G.camera._reversedDepth=X,G.map===null||U===!0){if(G.map!==null&&(G.map.depthTexture!==null&&(G.map.depthTexture.dispose(),G.map.depthTexture=null),G.map.dispose()),this.type===Zs){if(H.isPointLight){Rt("WebGLShadowMap: VSM shadow maps are not supported for PointLights. Use PCF or BasicShadowMap instead.");continue}G.map=new on(s.x,s.y,{format:Hi,type:Wn,minFilter:rn,magFilter:rn,generateMipmaps:!1}),G.map.texture.name=H.name+".shadowMap",G.map.depthTexture=new _i(s.x,s.y,Hn),G.map.depthTexture.name=H.name+".shadowMapDepth",G.map.depthTexture.format=xi,G.map.depthTexture.compareFunction=null,G.map.depthTexture.minFilter=Ce,G.map.depthTexture.magFilter=Ce}else H.isPointLight?(G.map=new oo(s.x),G.map.depthTexture=new Gr(s.x,Gn)):(G.map=new on(s.x,s.y),G.map.depthTexture=new _i(s.x,s.y,Gn)),G.map.depthTexture.name=H.name+".shadowMap",G.map.depthTexture.format=xi,this.type===$r?(G.map.depthTexture.compareFunction=X?Xu:Wu,G.map.depthTexture.minFilter=rn,G.map.depthTexture.magFilter=rn):(G.map.depthTexture.compareFunction=null,G.map.depthTexture.minFilter=Ce,G.map.depthTexture.magFilter=Ce);G.camera.updateProjectionMatrix()}G.map.isWebGLCubeRenderTarget!==!0&&(G.map.width!==s.x||G.map.height!==s.y)&&G.map.setSize(s.x,s.y);let j=G.map.isWebGLCubeRenderTarget?6:G.getViewportCount();H.isPointLight!==!0&&G.updateMatrices(H,b);let tt=(G.camera.layers.mask&4294967294)!==0?G.camera.layers:b.layers;for(let yt=0;yt<j;yt++){let Nt=G.getCamera(yt);if(H.isPointLight){let J=G.camera,ut=G.matrix,_t=H.distance||J.far;_t!==J.far&&(J.far=_t,J.updateProjectionMatrix()),so.setFromMatrixPosition(H.matrixWorld),J.position.copy(so),th.copy(J.position),th.add(Iv[yt]),J.up.copy(Lv[yt]),J.lookAt(th),J.updateMatrixWorld(),ut.makeTranslation(-so.x,-so.y,-so.z),cp.multiplyMatrices(J.projectionMatrix,J.matrixWorldInverse),G._frustum.setFromProjectionMatrix(cp,J.coordinateSystem,J.reversedDepth)}if(G.map.isWebGLCubeRenderTarget)i.setRenderTarget(G.map,yt),i.clear();else{yt===0&&(i.setRenderTarget(G.map),i.clear());let J=G.getViewport(yt);o.set(r.x*J.x,r.y*J.y,r.x*J.z,r.y*J.w),I.viewport(o)}n=G.getFrustum(yt),v(_,b,Nt,H,tt,this.type)}G.isPointLightShadow!==!0&&this.type===Zs&&x(G,b),G.needsUpdate=!1}m=this.type,p.needsUpdate=!1,i.setRenderTarget(L,E,C)};function x(A,_){let b=t.update(y);f.defines.VSM_SAMPLES!==A.blurSamples&&(f.defines.VSM_SAMPLES=A.blurSamples,d.defines.VSM_SAMPLES=A.blurSamples,f.needsUpdate=!0,d.needsUpdate=!0),A.mapPass===null?A.mapPass=new on(s.x,s.y,{format:Hi,type:Wn}):(A.mapPass.width!==A.map.width||A.mapPass.height!==A.map.height)&&A.mapPass.setSize(A.map.width,A.map.height),f.uniforms.shadow_pass.value=A.map.depthTexture,f.uniforms.resolution.value.set(A.map.width,A.map.height),f.uniforms.radius.value=A.radius,i.setRenderTarget(A.mapPass),i.clear(),i.renderBufferDirect(_,null,b,f,y,null),d.uniforms.shadow_pass.value=A.mapPass.texture,d.uniforms.resolution.value.set(A.map.width,A.map.height),d.uniforms.radius.value=A.radius,i.setRenderTarget(A.map),i.clear(),i.renderBufferDirect(_,null,b,d,y,null)}function M(A,_,b,L){let E=null,C=b.isPointLight===!0?A.customDistanceMaterial:A.customDepthMaterial;if(C!==void 0)E=C;else if(E=b.isPointLight===!0?a:l,i.localClippingEnabled&&_.clipShadows===!0&&Array.isArray(_.clippingPlanes)&&_.clippingPlanes.length!==0||_.displacementMap&&_.displacementScale!==0||_.alphaMap&&_.alphaTest>0||_.map&&_.alphaTest>0||_.alphaToCoverage===!0){let I=E.uuid,U=_.uuid,P=c[I];P===void 0&&(P={},c[I]=P);let B=P[U];B===void 0&&(B=E.clone(),P[U]=B,_.addEventListener("dispose",S)),E=B}if(E.visible=_.visible,E.wireframe=_.wireframe,L===Zs?E.side=_.shadowSide!==null?_.shadowSide:_.side:E.side=_.shadowSide!==null?_.shadowSide:h[_.side],E.alphaMap=_.alphaMap,E.alphaTest=_.alphaToCoverage===!0?.5:_.alphaTest,E.map=_.map,E.clipShadows=_.clipShadows,E.clippingPlanes=_.clippingPlanes,E.clipIntersection=_.clipIntersection,E.displacementMap=_.displacementMap,E.displacementScale=_.displacementScale,E.displacementBias=_.displacementBias,E.wireframeLinewidth=_.wireframeLinewidth,E.linewidth=_.linewidth,b.isPointLight===!0&&E.isMeshDistanceMaterial===!0){let I=i.properties.get(E);I.light=b}return E}function v(A,_,b,L,E,C){if(A.visible===!1)return;if(A.layers.test(E)&&(A.isMesh||A.isLine||A.isPoints)&&(A.castShadow||A.receiveShadow&&C===Zs)&&(!A.frustumCulled||A.intersectsFrustum(n))){A.modelViewMatrix.multiplyMatrices(b.matrixWorldInverse,A.matrixWorld);let P=t.update(A),B=A.material;if(Array.isArray(B)){let H=P.groups;for(let G=0,et=H.length;G<et;G++){let X=H[G],j=B[X.materialIndex];if(j&&j.visible){let tt=M(A,j,L,C);A.onBeforeShadow(i,A,_,b,P,tt,X),i.renderBufferDirect(b,null,P,tt,A,X),A.onAfterShadow(i,A,_,b,P,tt,X)}}}else if(B.visible){let H=M(A,B,L,C);A.onBeforeShadow(i,A,_,b,P,H,null),i.renderBufferDirect(b,null,P,H,A,null),A.onAfterShadow(i,A,_,b,P,H,null)}}let U=A.children;for(let P=0,B=U.length;P<B;P++)v(U[P],_,b,L,E,C)}function S(A){A.target.removeEventListener("dispose",S);for(let b in c){let L=c[b],E=A.target.uuid;E in L&&(L[E].dispose(),delete L[E])}}}function Dv(i,t){function e(){let D=!1,K=new me,q=null,lt=new me(0,0,0,0);return{setMask:function(st){q!==st&&!D&&(i.colorMask(st,st,st,st),q=st)},setLocked:function(st){D=st},setClear:function(st,ot,wt,Vt,it){it===!0&&(st*=Vt,ot*=Vt,wt*=Vt),K.set(st,ot,wt,Vt),lt.equals(K)===!1&&(i.clearColor(st,ot,wt,Vt),lt.copy(K))},reset:function(){D=!1,q=null,lt.set(-1,0,0,0)}}}function n(){let D=!1,K=!1,q=null,lt=null,st=null;return{setReversed:function(ot){if(K!==ot){let wt=t.get("EXT_clip_control");ot?wt.clipControlEXT(wt.LOWER_LEFT_EXT,wt.ZERO_TO_ONE_EXT):wt.clipControlEXT(wt.LOWER_LEFT_EXT,wt.NEGATIVE_ONE_TO_ONE_EXT),K=ot;let Vt=st;st=null,this.setClear(Vt)}},getReversed:function(){return K},setTest:function(ot){ot?pt(i.DEPTH_TEST):Ut(i.DEPTH_TEST)},setMask:function(ot){q!==ot&&!D&&(i.depthMask(ot),q=ot)},setFunc:function(ot){if(K&&(ot=Od[ot]),lt!==ot){switch(ot){case aa:i.depthFunc(i.NEVER);break;case la:i.depthFunc(i.ALWAYS);break;case ca:i.depthFunc(i.LESS);break;case ks:i.depthFunc(i.LEQUAL);break;case ua:i.depthFunc(i.EQUAL);break;case ha:i.depthFunc(i.GEQUAL);break;case Vs:i.depthFunc(i.GREATER);break;case fa:i.depthFunc(i.NOTEQUAL);break;default:i.depthFunc(i.LEQUAL)}lt=ot}},setLocked:function(ot){D=ot},setClear:function(ot){st!==ot&&(st=ot,K&&(ot=1-ot),i.clearDepth(ot))},reset:function(){D=!1,q=null,lt=null,st=null,K=!1}}}function s(){let D=!1,K=null,q=null,lt=null,st=null,ot=null,wt=null,Vt=null,it=null;return{setTest:function(At){D||(At?pt(i.STENCIL_TEST):Ut(i.STENCIL_TEST))},setMask:function(At){K!==At&&!D&&(i.stencilMask(At),K=At)},setFunc:function(At,kt,mt){(q!==At||lt!==kt||st!==mt)&&(i.stencilFunc(At,kt,mt),q=At,lt=kt,st=mt)},setOp:function(At,kt,mt){(ot!==At||wt!==kt||Vt!==mt)&&(i.stencilOp(At,kt,mt),ot=At,wt=kt,Vt=mt)},setLocked:function(At){D=At},setClear:function(At){it!==At&&(i.clearStencil(At),it=At)},reset:function(){D=!1,K=null,q=null,lt=null,st=null,ot=null,wt=null,Vt=null,it=null}}}let r=new e,o=new n,l=new s,a={},c=new WeakMap,u={},h={},f={},d=new WeakMap,g=[],y=null,p=!1,m=null,x=null,M=null,v=null,S=null,A=null,_=null,b=new Zt(0,0,0),L=0,E=!1,C=null,I=null,U=null,P=null,B=null,H=i.getParameter(i.MAX_COMBINED_TEXTURE_IMAGE_UNITS),G=!1,et=0,X=i.getParameter(i.VERSION);X.indexOf("WebGL")!==-1?(et=parseFloat(/^WebGL (\d)/.exec(X)[1]),G=et>=1):X.indexOf("OpenGL ES")!==-1&&(et=parseFloat(/^OpenGL ES (\d)/.exec(X)[1]),G=et>=2);let j=null,tt={},yt=i.getParameter(i.SCISSOR_BOX),Nt=i.getParameter(i.VIEWPORT),J=new me().fromArray(yt),ut=new me().fromArray(Nt);function _t(D,K,q,lt){let st=new Uint8Array(4),ot=i.createTexture();i.bindTexture(D,ot),i.texParameteri(D,i.TEXTURE_MIN_FILTER,i.NEAREST),i.texParameteri(D,i.TEXTURE_MAG_FILTER,i.NEAREST);for(let wt=0;wt<q;wt++)D===i.TEXTURE_3D||D===i.TEXTURE_2D_ARRAY?i.texImage3D(K,0,i.RGBA,1,1,lt,0,i.RGBA,i.UNSIGNED_BYTE,st):i.texImage2D(K+wt,0,i.RGBA,1,1,0,i.RGBA,i.UNSIGNED_BYTE,st);return ot}let Tt={};Tt[i.TEXTURE_2D]=_t(i.TEXTURE_2D,i.TEXTURE_2D,1),Tt[i.TEXTURE_CUBE_MAP]=_t(i.TEXTURE_CUBE_MAP,i.TEXTURE_CUBE_MAP_POSITIVE_X,6),Tt[i.TEXTURE_2D_ARRAY]=_t(i.TEXTURE_2D_ARRAY,i.TEXTURE_2D_ARRAY,1,1),Tt[i.TEXTURE_3D]=_t(i.TEXTURE_3D,i.TEXTURE_3D,1,1),r.setClear(0,0,0,1),o.setClear(1),l.setClear(0),pt(i.DEPTH_TEST),o.setFunc(ks),un(!1),ve(yu),pt(i.CULL_FACE),Ve(hs);function pt(D){u[D]!==!0&&(i.enable(D),u[D]=!0)}function Ut(D){u[D]!==!1&&(i.disable(D),u[D]=!1)}function Se(D,K){return f[D]!==K?(i.bindFramebuffer(D,K),f[D]=K,D===i.DRAW_FRAMEBUFFER&&(f[i.FRAMEBUFFER]=K),D===i.FRAMEBUFFER&&(f[i.DRAW_FRAMEBUFFER]=K),!0):!1}function Ct(D,K){let q=g,lt=!1;if(D){q=d.get(K),q===void 0&&(q=[],d.set(K,q));let st=D.textures;if(q.length!==st.length||q[0]!==i.COLOR_ATTACHMENT0){for(let ot=0,wt=st.length;ot<wt;ot++)q[ot]=i.COLOR_ATTACHMENT0+ot;q.length=st.length,lt=!0}}else q[0]!==i.BACK&&(q[0]=i.BACK,lt=!0);lt&&i.drawBuffers(q)}function Kt(D){return y!==D?(i.useProgram(D),y=D,!0):!1}let ae={[fs]:i.FUNC_ADD,[od]:i.FUNC_SUBTRACT,[ad]:i.FUNC_REVERSE_SUBTRACT};ae[ld]=i.MIN,ae[cd]=i.MAX;let Wt={[ud]:i.ZERO,[hd]:i.ONE,[fd]:i.SRC_COLOR,[bu]:i.SRC_ALPHA,[_d]:i.SRC_ALPHA_SATURATE,[gd]:i.DST_COLOR,[pd]:i.DST_ALPHA,[dd]:i.ONE_MINUS_SRC_COLOR,[wu]:i.ONE_MINUS_SRC_ALPHA,[xd]:i.ONE_MINUS_DST_COLOR,[md]:i.ONE_MINUS_DST_ALPHA,[yd]:i.CONSTANT_COLOR,[vd]:i.ONE_MINUS_CONSTANT_COLOR,[Md]:i.CONSTANT_ALPHA,[Sd]:i.ONE_MINUS_CONSTANT_ALPHA};function Ve(D,K,q,lt,st,ot,wt,Vt,it,At){if(D===hs){p===!0&&(Ut(i.BLEND),p=!1);return}if(p===!1&&(pt(i.BLEND),p=!0),D!==rd){if(D!==m||At!==E){if((x!==fs||S!==fs)&&(i.blendEquation(i.FUNC_ADD),x=fs,S=fs),At)switch(D){case Js:i.blendFuncSeparate(i.ONE,i.ONE_MINUS_SRC_ALPHA,i.ONE,i.ONE_MINUS_SRC_ALPHA);break;case vu:i.blendFunc(i.ONE,i.ONE);break;case Mu:i.blendFuncSeparate(i.ZERO,i.ONE_MINUS_SRC_COLOR,i.ZERO,i.ONE);break;case Su:i.blendFuncSeparate(i.DST_COLOR,i.ONE_MINUS_SRC_ALPHA,i.ZERO,i.ONE);break;default:Lt("WebGLState: Invalid blending: ",D);break}else switch(D){case Js:i.blendFuncSeparate(i.SRC_ALPHA,i.ONE_MINUS_SRC_ALPHA,i.ONE,i.ONE_MINUS_SRC_ALPHA);break;case vu:i.blendFuncSeparate(i.SRC_ALPHA,i.ONE,i.ONE,i.ONE);break;case Mu:Lt("WebGLState: SubtractiveBlending requires material.premultipliedAlpha = true");break;case Su:Lt("WebGLState: MultiplyBlending requires material.premultipliedAlpha = true");break;default:Lt("WebGLState: Invalid blending: ",D);break}M=null,v=null,A=null,_=null,b.set(0,0,0),L=0,m=D,E=At}return}st=st||K,ot=ot||q,wt=wt||lt,(K!==x||st!==S)&&(i.blendEquationSeparate(ae[K],ae[st]),x=K,S=st),(q!==M||lt!==v||ot!==A||wt!==_)&&(i.blendFuncSeparate(Wt[q],Wt[lt],Wt[ot],Wt[wt]),M=q,v=lt,A=ot,_=wt),(Vt.equals(b)===!1||it!==L)&&(i.blendColor(Vt.r,Vt.g,Vt.b,it),b.copy(Vt),L=it),m=D,E=!1}function Pe(D,K){D.side===ye?Ut(i.CULL_FACE):pt(i.CULL_FACE);let q=D.side===qe;K&&(q=!q),un(q),D.blending===Js&&D.transparent===!1?Ve(hs):Ve(D.blending,D.blendEquation,D.blendSrc,D.blendDst,D.blendEquationAlpha,D.blendSrcAlpha,D.blendDstAlpha,D.blendColor,D.blendAlpha,D.premultipliedAlpha),o.setFunc(D.depthFunc),o.setTest(D.depthTest),o.setMask(D.depthWrite),r.setMask(D.colorWrite);let lt=D.stencilWrite;l.setTest(lt),lt&&(l.setMask(D.stencilWriteMask),l.setFunc(D.stencilFunc,D.stencilRef,D.stencilFuncMask),l.setOp(D.stencilFail,D.stencilZFail,D.stencilZPass)),Fe(D.polygonOffset,D.polygonOffsetFactor,D.polygonOffsetUnits),D.alphaToCoverage===!0?pt(i.SAMPLE_ALPHA_TO_COVERAGE):Ut(i.SAMPLE_ALPHA_TO_COVERAGE)}function un(D){C!==D&&(D?i.frontFace(i.CW):i.frontFace(i.CCW),C=D)}function ve(D){D!==nd?(pt(i.CULL_FACE),D!==I&&(D===yu?i.cullFace(i.BACK):D===id?i.cullFace(i.FRONT):i.cullFace(i.FRONT_AND_BACK))):Ut(i.CULL_FACE),I=D}function Yn(D){D!==U&&(G&&i.lineWidth(D),U=D)}function Fe(D,K,q){D?(pt(i.POLYGON_OFFSET_FILL),(P!==K||B!==q)&&(P=K,B=q,o.getReversed()&&(K=-K,q=-q),i.polygonOffset(K,q))):Ut(i.POLYGON_OFFSET_FILL)}function wn(D){D?pt(i.SCISSOR_TEST):Ut(i.SCISSOR_TEST)}function An(D){D===void 0&&(D=i.TEXTURE0+H-1),j!==D&&(i.activeTexture(D),j=D)}function Tn(D,K,q){q===void 0&&(j===null?q=i.TEXTURE0+H-1:q=j);let lt=tt[q];lt===void 0&&(lt={type:void 0,texture:void 0},tt[q]=lt),(lt.type!==D||lt.texture!==K)&&(j!==q&&(i.activeTexture(q),j=q),i.bindTexture(D,K||Tt[D]),lt.type=D,lt.texture=K)}function O(){let D=tt[j];D!==void 0&&D.type!==void 0&&(i.bindTexture(D.type,null),D.type=void 0,D.texture=void 0)}function En(){try{i.compressedTexImage2D(...arguments)}catch(D){Lt("WebGLState:",D)}}function ge(){try{i.compressedTexImage3D(...arguments)}catch(D){Lt("WebGLState:",D)}}function xe(){try{i.texSubImage2D(...arguments)}catch(D){Lt("WebGLState:",D)}}function dt(){try{i.texSubImage3D(...arguments)}catch(D){Lt("WebGLState:",D)}}function Ie(){try{i.compressedTexSubImage2D(...arguments)}catch(D){Lt("WebGLState:",D)}}function Pt(){try{i.compressedTexSubImage3D(...arguments)}catch(D){Lt("WebGLState:",D)}}function Ft(){try{i.texStorage2D(...arguments)}catch(D){Lt("WebGLState:",D)}}function R(){try{i.texStorage3D(...arguments)}catch(D){Lt("WebGLState:",D)}}function w(){try{i.texImage2D(...arguments)}catch(D){Lt("WebGLState:",D)}}function k(){try{i.texImage3D(...arguments)}catch(D){Lt("WebGLState:",D)}}function nt(D){return h[D]!==void 0?h[D]:i.getParameter(D)}function Q(D,K){h[D]!==K&&(i.pixelStorei(D,K),h[D]=K)}function rt(D){J.equals(D)===!1&&(i.scissor(D.x,D.y,D.z,D.w),J.copy(D))}function ht(D){ut.equals(D)===!1&&(i.viewport(D.x,D.y,D.z,D.w),ut.copy(D))}function $(D,K){let q=c.get(K);q===void 0&&(q=new WeakMap,c.set(K,q));let lt=q.get(D);lt===void 0&&(lt=i.getUniformBlockIndex(K,D.name),i.uniformBlockBinding(K,lt,lt),q.set(D,lt))}function Z(D,K,q){let st=c.get(K).get(D);a[st]!==q&&(i.bindBufferBase(i.UNIFORM_BUFFER,st,q),a[st]=q)}function at(){i.disable(i.BLEND),i.disable(i.CULL_FACE),i.disable(i.DEPTH_TEST),i.disable(i.POLYGON_OFFSET_FILL),i.disable(i.SCISSOR_TEST),i.disable(i.STENCIL_TEST),i.disable(i.SAMPLE_ALPHA_TO_COVERAGE),i.blendEquation(i.FUNC_ADD),i.blendFunc(i.ONE,i.ZERO),i.blendFuncSeparate(i.ONE,i.ZERO,i.ONE,i.ZERO),i.blendColor(0,0,0,0),i.colorMask(!0,!0,!0,!0),i.clearColor(0,0,0,0),i.depthMask(!0),i.depthFunc(i.LESS),o.setReversed(!1),i.clearDepth(1),i.stencilMask(4294967295),i.stencilFunc(i.ALWAYS,0,4294967295),i.stencilOp(i.KEEP,i.KEEP,i.KEEP),i.clearStencil(0),i.cullFace(i.BACK),i.frontFace(i.CCW),i.polygonOffset(0,0),i.activeTexture(i.TEXTURE0),i.bindFramebuffer(i.FRAMEBUFFER,null),i.bindFramebuffer(i.DRAW_FRAMEBUFFER,null),i.bindFramebuffer(i.READ_FRAMEBUFFER,null),i.useProgram(null),i.lineWidth(1),i.scissor(0,0,i.canvas.width,i.canvas.height),i.viewport(0,0,i.canvas.width,i.canvas.height),i.pixelStorei(i.PACK_ALIGNMENT,4),i.pixelStorei(i.UNPACK_ALIGNMENT,4),i.pixelStorei(i.UNPACK_FLIP_Y_WEBGL,!1),i.pixelStorei(i.UNPACK_PREMULTIPLY_ALPHA_WEBGL,!1),i.pixelStorei(i.UNPACK_COLORSPACE_CONVERSION_WEBGL,i.BROWSER_DEFAULT_WEBGL),i.pixelStorei(i.PACK_ROW_LENGTH,0),i.pixelStorei(i.PACK_SKIP_PIXELS,0),i.pixelStorei(i.PACK_SKIP_ROWS,0),i.pixelStorei(i.UNPACK_ROW_LENGTH,0),i.pixelStorei(i.UNPACK_IMAGE_HEIGHT,0),i.pixelStorei(i.UNPACK_SKIP_PIXELS,0),i.pixelStorei(i.UNPACK_SKIP_ROWS,0),i.pixelStorei(i.UNPACK_SKIP_IMAGES,0),u={},h={},j=null,tt={},f={},a={},d=new WeakMap,g=[],y=null,p=!1,m=null,x=null,M=null,v=null,S=null,A=null,_=null,b=new Zt(0,0,0),L=0,E=!1,C=null,I=null,U=null,P=null,B=null,J.set(0,0,i.canvas.width,i.canvas.height),ut.set(0,0,i.canvas.width,i.canvas.height),r.reset(),o.reset(),l.reset()}return{buffers:{color:r,depth:o,stencil:l},enable:pt,disable:Ut,bindFramebuffer:Se,drawBuffers:Ct,useProgram:Kt,setBlending:Ve,setMaterial:Pe,setFlipSided:un,setCullFace:ve,setLineWidth:Yn,setPolygonOffset:Fe,setScissorTest:wn,activeTexture:An,bindTexture:Tn,unbindTexture:O,compressedTexImage2D:En,compressedTexImage3D:ge,texImage2D:w,texImage3D:k,pixelStorei:Q,getParameter:nt,updateUBOMapping:$,uniformBlockBinding:Z,texStorage2D:Ft,texStorage3D:R,texSubImage2D:xe,texSubImage3D:dt,compressedTexSubImage2D:Ie,compressedTexSubImage3D:Pt,scissor:rt,viewport:ht,reset:at}}function Uv(i,t,e,n,s,r,o){let l=t.has("WEBGL_multisampled_render_to_texture")?t.get("WEBGL_multisampled_render_to_texture"):null,a=typeof navigator>"u"?!1:/OculusBrowser/g.test(navigator.userAgent),c=new Et,u=new WeakMap,h=new Set,f,d=new WeakMap,g=new Set,y=new FinalizationRegistry(R=>g.delete(R)),p=!1;try{p=typeof OffscreenCanvas<"u"&&new OffscreenCanvas(1,1).getContext("2d")!==null}catch{}function m(R,w){return p?new OffscreenCanvas(R,w):Ur("canvas")}function x(R,w,k){let nt=1,Q=Ft(R);if((Q.width>k||Q.height>k)&&(nt=k/Math.max(Q.width,Q.height)),nt<1)if(typeof HTMLImageElement<"u"&&R instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&R instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&R instanceof ImageBitmap||typeof VideoFrame<"u"&&R instanceof VideoFrame){let rt=Math.floor(nt*Q.width),ht=Math.floor(nt*Q.height);f===void 0&&(f=m(rt,ht));let $=w?m(rt,ht):f;return $.width=rt,$.height=ht,$.getContext("2d").drawImage(R,0,0,rt,ht),Rt("WebGLRenderer: Texture has been resized from ("+Q.width+"x"+Q.height+") to ("+rt+"x"+ht+")."),$}else return"data"in R&&Rt("WebGLRenderer: Image in DataTexture is too big ("+Q.width+"x"+Q.height+")."),R;return R}function M(R){return R.generateMipmaps}function v(R){i.generateMipmap(R)}function S(R){return R.isWebGLCubeRenderTarget?i.TEXTURE_CUBE_MAP:R.isWebGL3DRenderTarget?i.TEXTURE_3D:R.isWebGLArrayRenderTarget||R.isCompressedArrayTexture?i.TEXTURE_2D_ARRAY:i.TEXTURE_2D}function A(R,w,k,nt,Q,rt=!1){if(R!==null){if(i[R]!==void 0)return i[R];Rt("WebGLRenderer: Attempt to use non-existing WebGL internal format '"+R+"'")}let ht;nt&&(ht=t.get("EXT_texture_norm16"),ht||Rt("WebGLRenderer: Unable to use normalized textures without EXT_texture_norm16 extension"));let $=w;if(w===i.RED&&(k===i.FLOAT&&($=i.R32F),k===i.HALF_FLOAT&&($=i.R16F),k===i.UNSIGNED_BYTE&&($=i.R8),k===i.UNSIGNED_SHORT&&ht&&($=ht.R16_EXT),k===i.SHORT&&ht&&($=ht.R16_SNORM_EXT)),w===i.RED_INTEGER&&(k===i.UNSIGNED_BYTE&&($=i.R8UI),k===i.UNSIGNED_SHORT&&($=i.R16UI),k===i.UNSIGNED_INT&&($=i.R32UI),k===i.BYTE&&($=i.R8I),k===i.SHORT&&($=i.R16I),k===i.INT&&($=i.R32I)),w===i.RG&&(k===i.FLOAT&&($=i.RG32F),k===i.HALF_FLOAT&&($=i.RG16F),k===i.UNSIGNED_BYTE&&($=i.RG8),k===i.UNSIGNED_SHORT&&ht&&($=ht.RG16_EXT),k===i.SHORT&&ht&&($=ht.RG16_SNORM_EXT)),w===i.RG_INTEGER&&(k===i.UNSIGNED_BYTE&&($=i.RG8UI),k===i.UNSIGNED_SHORT&&($=i.RG16UI),k===i.UNSIGNED_INT&&($=i.RG32UI),k===i.BYTE&&($=i.RG8I),k===i.SHORT&&($=i.RG16I),k===i.INT&&($=i.RG32I)),w===i.RGB_INTEGER&&(k===i.UNSIGNED_BYTE&&($=i.RGB8UI),k===i.UNSIGNED_SHORT&&($=i.RGB16UI),k===i.UNSIGNED_INT&&($=i.RGB32UI),k===i.BYTE&&($=i.RGB8I),k===i.SHORT&&($=i.RGB16I),k===i.INT&&($=i.RGB32I)),w===i.RGBA_INTEGER&&(k===i.UNSIGNED_BYTE&&($=i.RGBA8UI),k===i.UNSIGNED_SHORT&&($=i.RGBA16UI),k===i.UNSIGNED_INT&&($=i.RGBA32UI),k===i.BYTE&&($=i.RGBA8I),k===i.SHORT&&($=i.RGBA16I),k===i.INT&&($=i.RGBA32I)),w===i.RGB&&(k===i.UNSIGNED_SHORT&&ht&&($=ht.RGB16_EXT),k===i.SHORT&&ht&&($=ht.RGB16_SNORM_EXT),k===i.UNSIGNED_INT_5_9_9_9_REV&&($=i.RGB9_E5),k===i.UNSIGNED_INT_10F_11F_11F_REV&&($=i.R11F_G11F_B10F)),w===i.RGBA){let Z=rt?Nr:Yt.getTransfer(Q);k===i.FLOAT&&($=i.RGBA32F),k===i.HALF_FLOAT&&($=i.RGBA16F),k===i.UNSIGNED_BYTE&&($=Z===ne?i.SRGB8_ALPHA8:i.RGBA8),k===i.UNSIGNED_SHORT&&ht&&($=ht.RGBA16_EXT),k===i.SHORT&&ht&&($=ht.RGBA16_SNORM_EXT),k===i.UNSIGNED_SHORT_4_4_4_4&&($=i.RGBA4),k===i.UNSIGNED_SHORT_5_5_5_1&&($=i.RGB5_A1)}return($===i.R16F||$===i.R32F||$===i.RG16F||$===i.RG32F||$===i.RGBA16F||$===i.RGBA32F)&&t.get("EXT_color_buffer_float"),$}function _(R,w){let k;return R?w===null||w===Gn||w===ps?k=i.DEPTH24_STENCIL8:w===Hn?k=i.DEPTH32F_STENCIL8:w===Qs&&(k=i.DEPTH24_STENCIL8,Rt("DepthTexture: 16 bit depth attachment is not supported with stencil. Using 24-bit attachment.")):w===null||w===Gn||w===ps?k=i.DEPTH_COMPONENT24:w===Hn?k=i.DEPTH_COMPONENT32F:w===Qs&&(k=i.DEPTH_COMPONENT16),k}function b(R,w){return M(R)===!0||R.isFramebufferTexture&&R.minFilter!==Ce&&R.minFilter!==rn?Math.log2(Math.max(w.width,w.height))+1:R.mipmaps.length>0?R.mipmaps.length:R.isCompressedTexture&&Array.isArray(R.image)?w.mipmaps.length:1}function L(R){let w=new WeakRef(R);n.get(R).__ref=w,g.add(w),y.register(R,w,w)}function E(R){let w=n.get(R).__ref;w!==void 0&&(g.delete(w),y.unregister(w))}function C(R){U(R.target)}function I(R){P(R.target)}function U(R){R.removeEventListener("dispose",C),E(R),H(R),R.isVideoTexture&&u.delete(R),R.isHTMLTexture&&h.delete(R)}function P(R){R.removeEventListener("dispose",I),E(R),et(R)}function B(){for(let R of g){let w=R.deref();w!==void 0&&(w.isRenderTarget===!0?P(w):U(w))}g.clear(),h.clear()}function H(R){let w=n.get(R);if(w.__webglInit===void 0)return;let k=R.source,nt=d.get(k);if(nt){let Q=nt[w.__cacheKey];Q.usedTimes--,Q.usedTimes===0&&G(R),Object.keys(nt).length===0&&d.delete(k)}n.remove(R)}function G(R){let w=n.get(R);i.deleteTexture(w.__webglTexture);let k=R.source,nt=d.get(k);delete nt[w.__cacheKey],o.memory.textures--}function et(R){let w=n.get(R);w.__depthDisposeCallback&&w.__depthDisposeCallback();let k=R.depthTexture;if(k&&k.renderTarget===R&&U(k),R.isWebGLCubeRenderTarget)for(let Q=0;Q<6;Q++){if(Array.isArray(w.__webglFramebuffer[Q]))for(let rt=0;rt<w.__webglFramebuffer[Q].length;rt++)i.deleteFramebuffer(w.__webglFramebuffer[Q][rt]);else i.deleteFramebuffer(w.__webglFramebuffer[Q]);w.__webglDepthbuffer&&i.deleteRenderbuffer(w.__webglDepthbuffer[Q])}else{if(Array.isArray(w.__webglFramebuffer))for(let Q=0;Q<w.__webglFramebuffer.length;Q++)i.deleteFramebuffer(w.__webglFramebuffer[Q]);else i.deleteFramebuffer(w.__webglFramebuffer);if(w.__webglDepthbuffer&&i.deleteRenderbuffer(w.__webglDepthbuffer),w.__webglMultisampledFramebuffer&&i.deleteFramebuffer(w.__webglMultisampledFramebuffer),w.__webglColorRenderbuffer)for(let Q=0;Q<w.__webglColorRenderbuffer.length;Q++)w.__webglColorRenderbuffer[Q]&&i.deleteRenderbuffer(w.__webglColorRenderbuffer[Q]);w.__webglDepthRenderbuffer&&i.deleteRenderbuffer(w.__webglDepthRenderbuffer)}let nt=R.textures;for(let Q=0,rt=nt.length;Q<rt;Q++){let ht=n.get(nt[Q]);ht.__webglTexture&&(i.deleteTexture(ht.__webglTexture),o.memory.textures--),n.remove(nt[Q])}n.remove(R)}let X=0;function j(){X=0}function tt(){return X}function yt(R){X=R}function Nt(){let R=X;return R>=s.maxTextures&&Rt("WebGLTextures: Trying to use "+(R+1)+" texture units while this GPU supports only "+s.maxTextures),X+=1,R}function J(R){let w=[];return w.push(R.wrapS),w.push(R.wrapT),w.push(R.wrapR||0),w.push(R.magFilter),w.push(R.minFilter),w.push(R.anisotropy),w.push(R.internalFormat),w.push(R.format),w.push(R.type),w.push(R.generateMipmaps),w.push(R.mipmapsAutoUpdate),w.push(R.premultiplyAlpha),w.push(R.flipY),w.push(R.unpackAlignment),w.push(R.colorSpace),w.join()}function ut(R,w){let k=n.get(R);if(R.isVideoTexture&&Ie(R),R.isRenderTargetTexture===!1&&R.isExternalTexture!==!0&&R.version>0&&k.__version!==R.version){let nt=R.image;if(nt===null)Rt("WebGLRenderer: Texture marked for update but no image data found.");else if(nt.complete===!1)Rt("WebGLRenderer: Texture marked for update but image is incomplete");else{Pe(k,R,w);return}}else R.isExternalTexture&&(k.__webglTexture=R.sourceTexture?R.sourceTexture:null);e.bindTexture(i.TEXTURE_2D,k.__webglTexture,i.TEXTURE0+w)}function _t(R,w){let k=n.get(R);if(R.isRenderTargetTexture===!1&&R.version>0&&k.__version!==R.version){Pe(k,R,w);return}else R.isExternalTexture&&(k.__webglTexture=R.sourceTexture?R.sourceTexture:null);e.bindTexture(i.TEXTURE_2D_ARRAY,k.__webglTexture,i.TEXTURE0+w)}function Tt(R,w){let k=n.get(R);if(R.isRenderTargetTexture===!1&&R.version>0&&k.__version!==R.version){Pe(k,R,w);return}e.bindTexture(i.TEXTURE_3D,k.__webglTexture,i.TEXTURE0+w)}function pt(R,w){let k=n.get(R);if(R.version>0&&k.__version!==R.version){un(k,R,w);return}e.bindTexture(i.TEXTURE_CUBE_MAP,k.__webglTexture,i.TEXTURE0+w)}let Ut={[da]:i.REPEAT,[Zn]:i.CLAMP_TO_EDGE,[pa]:i.MIRRORED_REPEAT},Se={[Ce]:i.NEAREST,[Ad]:i.NEAREST_MIPMAP_NEAREST,[Zr]:i.NEAREST_MIPMAP_LINEAR,[rn]:i.LINEAR,[Ga]:i.LINEAR_MIPMAP_NEAREST,[vi]:i.LINEAR_MIPMAP_LINEAR},Ct={[Rd]:i.NEVER,[qu]:i.ALWAYS,[Cd]:i.LESS,[Wu]:i.LEQUAL,[Pd]:i.EQUAL,[Xu]:i.GEQUAL,[Id]:i.GREATER,[Ld]:i.NOTEQUAL};function Kt(R,w){if(w.type===Hn&&t.has("OES_texture_float_linear")===!1&&(w.magFilter===rn||w.magFilter===Ga||w.magFilter===Zr||w.magFilter===vi||w.minFilter===rn||w.minFilter===Ga||w.minFilter===Zr||w.minFilter===vi)&&Rt("WebGLRenderer: Unable to use linear filtering with floating point textures. OES_texture_float_linear not supported on this device."),i.texParameteri(R,i.TEXTURE_WRAP_S,Ut[w.wrapS]),i.texParameteri(R,i.TEXTURE_WRAP_T,Ut[w.wrapT]),(R===i.TEXTURE_3D||R===i.TEXTURE_2D_ARRAY)&&i.texParameteri(R,i.TEXTURE_WRAP_R,Ut[w.wrapR]),i.texParameteri(R,i.TEXTURE_MAG_FILTER,Se[w.magFilter]),i.texParameteri(R,i.TEXTURE_MIN_FILTER,Se[w.minFilter]),w.compareFunction&&(i.texParameteri(R,i.TEXTURE_COMPARE_MODE,i.COMPARE_REF_TO_TEXTURE),i.texParameteri(R,i.TEXTURE_COMPARE_FUNC,Ct[w.compareFunction])),t.has("EXT_texture_filter_anisotropic")===!0){if(w.magFilter===Ce||w.minFilter!==Zr&&w.minFilter!==vi||w.type===Hn&&t.has("OES_texture_float_linear")===!1)return;if(w.anisotropy>1||n.get(w).__currentAnisotropy){let k=t.get("EXT_texture_filter_anisotropic");i.texParameterf(R,k.TEXTURE_MAX_ANISOTROPY_EXT,Math.min(w.anisotropy,s.getMaxAnisotropy())),n.get(w).__currentAnisotropy=w.anisotropy}}}function ae(R,w){let k=!1;R.__webglInit===void 0&&(R.__webglInit=!0,w.addEventListener("dispose",C),L(w));let nt=w.source,Q=d.get(nt);Q===void 0&&(Q={},d.set(nt,Q));let rt=J(w);if(rt!==R.__cacheKey){Q[rt]===void 0&&(Q[rt]={texture:i.createTexture(),usedTimes:0},o.memory.textures++,k=!0),Q[rt].usedTimes++;let ht=Q[R.__cacheKey];ht!==void 0&&(Q[R.__cacheKey].usedTimes--,ht.usedTimes===0&&G(w)),R.__cacheKey=rt,R.__webglTexture=Q[rt].texture}return k}function Wt(R,w,k){return Math.floor(Math.floor(R/k)/w)}function Ve(R,w,k,nt){let rt=R.updateRanges;if(rt.length===0)e.texSubImage2D(i.TEXTURE_2D,0,0,0,w.width,w.height,k,nt,w.data);else{rt.sort((D,K)=>D.start-K.start);let ht=0;for(let D=1;D<rt.length;D++){let K=rt[ht],q=rt[D],lt=K.start+K.count,st=Wt(q.start,w.width,4),ot=Wt(K.start,w.width,4);q.start<=lt+1&&st===ot&&Wt(q.start+q.count-1,w.width,4)===st?K.count=Math.max(K.count,q.start+q.count-K.start):(++ht,rt[ht]=q)}rt.length=ht+1;let $=e.getParameter(i.UNPACK_ROW_LENGTH),Z=e.getParameter(i.UNPACK_SKIP_PIXELS),at=e.getParameter(i.UNPACK_SKIP_ROWS);e.pixelStorei(i.UNPACK_ROW_LENGTH,w.width);for(let D=0,K=rt.length;D<K;D++){let q=rt[D],lt=Math.floor(q.start/4),st=Math.ceil(q.count/4),ot=lt%w.width,wt=Math.floor(lt/w.width),Vt=st,it=1;e.pixelStorei(i.UNPACK_SKIP_PIXELS,ot),e.pixelStorei(i.UNPACK_SKIP_ROWS,wt),e.texSubImage2D(i.TEXTURE_2D,0,ot,wt,Vt,it,k,nt,w.data)}R.clearUpdateRanges(),e.pixelStorei(i.UNPACK_ROW_LENGTH,$),e.pixelStorei(i.UNPACK_SKIP_PIXELS,Z),e.pixelStorei(i.UNPACK_SKIP_ROWS,at)}}function Pe(R,w,k){let nt=i.TEXTURE_2D;(w.isDataArrayTexture||w.isCompressedArrayTexture)&&(nt=i.TEXTURE_2D_ARRAY),w.isData3DTexture&&(nt=i.TEXTURE_3D);let Q=ae(R,w),rt=w.source;e.bindTexture(nt,R.__webglTexture,i.TEXTURE0+k);let ht=n.get(rt);if(rt.version!==ht.__version||Q===!0){if(e.activeTexture(i.TEXTURE0+k),(typeof ImageBitmap<"u"&&w.image instanceof ImageBitmap)===!1){let it=Yt.getPrimaries(Yt.workingColorSpace),At=w.colorSpace===Si?null:Yt.getPrimaries(w.colorSpace),kt=w.colorSpace===Si||it===At?i.NONE:i.BROWSER_DEFAULT_WEBGL;e.pixelStorei(i.UNPACK_FLIP_Y_WEBGL,w.flipY),e.pixelStorei(i.UNPACK_PREMULTIPLY_ALPHA_WEBGL,w.premultiplyAlpha),e.pixelStorei(i.UNPACK_COLORSPACE_CONVERSION_WEBGL,kt)}e.pixelStorei(i.UNPACK_ALIGNMENT,w.unpackAlignment);let Z=x(w.image,!1,s.maxTextureSize);Z=Pt(w,Z);let at=r.convert(w.format,w.colorSpace),D=r.convert(w.type),K=A(w.internalFormat,at,D,w.normalized,w.colorSpace,w.isVideoTexture);Kt(nt,w);let q,lt=w.mipmaps,st=w.isVideoTexture!==!0,ot=ht.__version===void 0||Q===!0,wt=rt.dataReady,Vt=b(w,Z);if(w.isDepthTexture)K=_(w.format===Mi,w.type),ot&&(st?e.texStorage2D(i.TEXTURE_2D,1,K,Z.width,Z.height):e.texImage2D(i.TEXTURE_2D,0,K,Z.width,Z.height,0,at,D,null));else if(w.isDataTexture)if(lt.length>0){st&&ot&&e.texStorage2D(i.TEXTURE_2D,Vt,K,lt[0].width,lt[0].height);for(let it=0,At=lt.length;it<At;it++)q=lt[it],st?wt&&e.texSubImage2D(i.TEXTURE_2D,it,0,0,q.width,q.height,at,D,q.data):e.texImage2D(i.TEXTURE_2D,it,K,q.width,q.height,0,at,D,q.data);w.generateMipmaps=!1}else st?(ot&&e.texStorage2D(i.TEXTURE_2D,Vt,K,Z.width,Z.height),wt&&Ve(w,Z,at,D)):e.texImage2D(i.TEXTURE_2D,0,K,Z.width,Z.height,0,at,D,Z.data);else if(w.isCompressedTexture)if(w.isCompressedArrayTexture){st&&ot&&e.texStorage3D(i.TEXTURE_2D_ARRAY,Vt,K,lt[0].width,lt[0].height,Z.depth);for(let it=0,At=lt.length;it<At;it++)if(q=lt[it],w.format!==Mn)if(at!==null)if(st){if(wt)if(w.layerUpdates.size>0){let kt=Qu(q.width,q.height,w.format,w.type);for(let mt of w.layerUpdates){let se=q.data.subarray(mt*kt/q.data.BYTES_PER_ELEMENT,(mt+1)*kt/q.data.BYTES_PER_ELEMENT);e.compressedTexSubImage3D(i.TEXTURE_2D_ARRAY,it,0,0,mt,q.width,q.height,1,at,se)}}else e.compressedTexSubImage3D(i.TEXTURE_2D_ARRAY,it,0,0,0,q.width,q.height,Z.depth,at,q.data)}else e.compressedTexImage3D(i.TEXTURE_2D_ARRAY,it,K,q.width,q.height,Z.depth,0,q.data,0,0);else Rt("WebGLRenderer: Attempt to load unsupported compressed texture format in .uploadTexture()");else st?wt&&e.texSubImage3D(i.TEXTURE_2D_ARRAY,it,0,0,0,q.width,q.height,Z.depth,at,D,q.data):e.texImage3D(i.TEXTURE_2D_ARRAY,it,K,q.width,q.height,Z.depth,0,at,D,q.data);w.layerUpdates.size>0&&w.clearLayerUpdates()}else{st&&ot&&e.texStorage2D(i.TEXTURE_2D,Vt,K,lt[0].width,lt[0].height);for(let it=0,At=lt.length;it<At;it++)q=lt[it],w.format!==Mn?at!==null?st?wt&&e.compressedTexSubImage2D(i.TEXTURE_2D,it,0,0,q.width,q.height,at,q.data):e.compressedTexImage2D(i.TEXTURE_2D,it,K,q.width,q.height,0,q.data):Rt("WebGLRenderer: Attempt to load unsupported compressed texture format in .uploadTexture()"):st?wt&&e.texSubImage2D(i.TEXTURE_2D,it,0,0,q.width,q.height,at,D,q.data):e.texImage2D(i.TEXTURE_2D,it,K,q.width,q.height,0,at,D,q.data)}else if(w.isDataArrayTexture)if(st){if(ot&&e.texStorage3D(i.TEXTURE_2D_ARRAY,Vt,K,Z.width,Z.height,Z.depth),wt)if(w.layerUpdates.size>0){let it=Qu(Z.width,Z.height,w.format,w.type);for(let At of w.layerUpdates){let kt=Z.data.subarray(At*it/Z.data.BYTES_PER_ELEMENT,(At+1)*it/Z.data.BYTES_PER_ELEMENT);e.texSubImage3D(i.TEXTURE_2D_ARRAY,0,0,0,At,Z.width,Z.height,1,at,D,kt)}w.clearLayerUpdates()}else e.texSubImage3D(i.TEXTURE_2D_ARRAY,0,0,0,0,Z.width,Z.height,Z.depth,at,D,Z.data)}else e.texImage3D(i.TEXTURE_2D_ARRAY,0,K,Z.width,Z.height,Z.depth,0,at,D,Z.data);else if(w.isData3DTexture)st?(ot&&e.texStorage3D(i.TEXTURE_3D,Vt,K,Z.width,Z.height,Z.depth),wt&&e.texSubImage3D(i.TEXTURE_3D,0,0,0,0,Z.width,Z.height,Z.depth,at,D,Z.data)):e.texImage3D(i.TEXTURE_3D,0,K,Z.width,Z.height,Z.depth,0,at,D,Z.data);else if(w.isFramebufferTexture){if(ot)if(st)e.texStorage2D(i.TEXTURE_2D,Vt,K,Z.width,Z.height);else{let it=Z.width,At=Z.height;for(let kt=0;kt<Vt;kt++)e.texImage2D(i.TEXTURE_2D,kt,K,it,At,0,at,D,null),it>>=1,At>>=1}}else if(w.isHTMLTexture){if("texElementImage2D"in i){let it=i.canvas;if(it.hasAttribute("layoutsubtree")||it.setAttribute("layoutsubtree","true"),Z.parentNode!==it){it.appendChild(Z),h.add(w),it.onpaint=At=>{let kt=At.changedElements;for(let mt of h)kt.includes(mt.image)&&(mt.needsUpdate=!0)},it.requestPaint();return}if(i.texElementImage2D.length===3)i.texElementImage2D(i.TEXTURE_2D,i.RGBA8,Z);else{let kt=i.RGBA,mt=i.RGBA,se=i.UNSIGNED_BYTE;i.texElementImage2D(i.TEXTURE_2D,0,kt,mt,se,Z)}i.texParameteri(i.TEXTURE_2D,i.TEXTURE_MIN_FILTER,i.LINEAR),i.texParameteri(i.TEXTURE_2D,i.TEXTURE_WRAP_S,i.CLAMP_TO_EDGE),i.texParameteri(i.TEXTURE_2D,i.TEXTURE_WRAP_T,i.CLAMP_TO_EDGE)}}else if(lt.length>0){if(st&&ot){let it=Ft(lt[0]);e.texStorage2D(i.TEXTURE_2D,Vt,K,it.width,it.height)}for(let it=0,At=lt.length;it<At;it++)q=lt[it],st?wt&&e.texSubImage2D(i.TEXTURE_2D,it,0,0,at,D,q):e.texImage2D(i.TEXTURE_2D,it,K,at,D,q);w.generateMipmaps=!1}else if(st){if(ot){let it=Ft(Z);e.texStorage2D(i.TEXTURE_2D,Vt,K,it.width,it.height)}wt&&e.texSubImage2D(i.TEXTURE_2D,0,0,0,at,D,Z)}else e.texImage2D(i.TEXTURE_2D,0,K,at,D,Z);M(w)&&w.mipmapsAutoUpdate===!0&&v(nt),ht.__version=rt.version,w.onUpdate&&w.onUpdate(w)}R.__version=w.version}function un(R,w,k){if(w.image.length!==6)return;let nt=ae(R,w),Q=w.source;e.bindTexture(i.TEXTURE_CUBE_MAP,R.__webglTexture,i.TEXTURE0+k);let rt=n.get(Q);if(Q.version!==rt.__version||nt===!0){e.activeTexture(i.TEXTURE0+k);let ht=Yt.getPrimaries(Yt.workingColorSpace),$=w.colorSpace===Si?null:Yt.getPrimaries(w.colorSpace),Z=w.colorSpace===Si||ht===$?i.NONE:i.BROWSER_DEFAULT_WEBGL;e.pixelStorei(i.UNPACK_FLIP_Y_WEBGL,w.flipY),e.pixelStorei(i.UNPACK_PREMULTIPLY_ALPHA_WEBGL,w.premultiplyAlpha),e.pixelStorei(i.UNPACK_ALIGNMENT,w.unpackAlignment),e.pixelStorei(i.UNPACK_COLORSPACE_CONVERSION_WEBGL,Z);let at=w.isCompressedTexture||w.image[0].isCompressedTexture,D=w.image[0]&&w.image[0].isDataTexture,K=[];for(let mt=0;mt<6;mt++)!at&&!D?K[mt]=x(w.image[mt],!0,s.maxCubemapSize):K[mt]=D?w.image[mt].image:w.image[mt],K[mt]=Pt(w,K[mt]);let q=K[0],lt=r.convert(w.format,w.colorSpace),st=r.convert(w.type),ot=A(w.internalFormat,lt,st,w.normalized,w.colorSpace),wt=w.isVideoTexture!==!0,Vt=rt.__version===void 0||nt===!0,it=Q.dataReady,At=b(w,q);Kt(i.TEXTURE_CUBE_MAP,w);let kt;if(w.isDepthTexture){if(ot=_(w.format===Mi,w.type),Vt)if(wt)e.texStorage2D(i.TEXTURE_CUBE_MAP,1,ot,q.width,q.height);else for(let mt=0;mt<6;mt++)e.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+mt,0,ot,q.width,q.height,0,lt,st,null)}else if(at){wt&&Vt&&e.texStorage2D(i.TEXTURE_CUBE_MAP,At,ot,q.width,q.height);for(let mt=0;mt<6;mt++){kt=K[mt].mipmaps;for(let se=0;se<kt.length;se++){let Oe=kt[se];w.format!==Mn?lt!==null?wt?it&&e.compressedTexSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+mt,se,0,0,Oe.width,Oe.height,lt,Oe.data):e.compressedTexImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+mt,se,ot,Oe.width,Oe.height,0,Oe.data):Rt("WebGLRenderer: Attempt to load unsupported compressed texture format in .setTextureCube()"):wt?it&&e.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+mt,se,0,0,Oe.width,Oe.height,lt,st,Oe.data):e.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+mt,se,ot,Oe.width,Oe.height,0,lt,st,Oe.data)}}}else{if(kt=w.mipmaps,wt&&Vt){kt.length>0&&At++;let mt=Ft(K[0]);e.texStorage2D(i.TEXTURE_CUBE_MAP,At,ot,mt.width,mt.height)}for(let mt=0;mt<6;mt++)if(D){wt?it&&e.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+mt,0,0,0,K[mt].width,K[mt].height,lt,st,K[mt].data):e.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+mt,0,ot,K[mt].width,K[mt].height,0,lt,st,K[mt].data);for(let se=0;se<kt.length;se++){let Ai=kt[se].image[mt].image;wt?it&&e.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+mt,se+1,0,0,Ai.width,Ai.height,lt,st,Ai.data):e.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+mt,se+1,ot,Ai.width,Ai.height,0,lt,st,Ai.data)}}else{wt?it&&e.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+mt,0,0,0,lt,st,K[mt]):e.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+mt,0,ot,lt,st,K[mt]);for(let se=0;se<kt.length;se++){let Oe=kt[se];wt?it&&e.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+mt,se+1,0,0,lt,st,Oe.image[mt]):e.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+mt,se+1,ot,lt,st,Oe.image[mt])}}}M(w)&&w.mipmapsAutoUpdate===!0&&v(i.TEXTURE_CUBE_MAP),rt.__version=Q.version,w.onUpdate&&w.onUpdate(w)}R.__version=w.version}function ve(R,w,k,nt,Q,rt){let ht=r.convert(k.format,k.colorSpace),$=r.convert(k.type),Z=A(k.internalFormat,ht,$,k.normalized,k.colorSpace),at=n.get(w),D=n.get(k);if(D.__renderTarget=w,!at.__hasExternalTextures){let K=Math.max(1,w.width>>rt),q=Math.max(1,w.height>>rt);Q===i.TEXTURE_3D||Q===i.TEXTURE_2D_ARRAY?e.texImage3D(Q,rt,Z,K,q,w.depth,0,ht,$,null):e.texImage2D(Q,rt,Z,K,q,0,ht,$,null)}e.bindFramebuffer(i.FRAMEBUFFER,R),dt(w)?l.framebufferTexture2DMultisampleEXT(i.FRAMEBUFFER,nt,Q,D.__webglTexture,0,xe(w)):(Q===i.TEXTURE_2D||Q>=i.TEXTURE_CUBE_MAP_POSITIVE_X&&Q<=i.TEXTURE_CUBE_MAP_NEGATIVE_Z)&&i.framebufferTexture2D(i.FRAMEBUFFER,nt,Q,D.__webglTexture,rt),e.bindFramebuffer(i.FRAMEBUFFER,null)}function Yn(R,w,k){if(i.bindRenderbuffer(i.RENDERBUFFER,R),w.depthBuffer){let nt=w.depthTexture,Q=nt&&nt.isDepthTexture?nt.type:null,rt=_(w.stencilBuffer,Q),ht=w.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT;dt(w)?l.renderbufferStorageMultisampleEXT(i.RENDERBUFFER,xe(w),rt,w.width,w.height):k?i.renderbufferStorageMultisample(i.RENDERBUFFER,xe(w),rt,w.width,w.height):i.renderbufferStorage(i.RENDERBUFFER,rt,w.width,w.height),i.framebufferRenderbuffer(i.FRAMEBUFFER,ht,i.RENDERBUFFER,R)}else{let nt=w.textures;for(let Q=0;Q<nt.length;Q++){let rt=nt[Q],ht=r.convert(rt.format,rt.colorSpace),$=r.convert(rt.type),Z=A(rt.internalFormat,ht,$,rt.normalized,rt.colorSpace);dt(w)?l.renderbufferStorageMultisampleEXT(i.RENDERBUFFER,xe(w),Z,w.width,w.height):k?i.renderbufferStorageMultisample(i.RENDERBUFFER,xe(w),Z,w.width,w.height):i.renderbufferStorage(i.RENDERBUFFER,Z,w.width,w.height)}}i.bindRenderbuffer(i.RENDERBUFFER,null)}function Fe(R,w,k){let nt=w.isWebGLCubeRenderTarget===!0;if(e.bindFramebuffer(i.FRAMEBUFFER,R),!(w.depthTexture&&w.depthTexture.isDepthTexture))throw new Error("THREE.WebGLTextures: renderTarget.depthTexture must be an instance of THREE.DepthTexture.");let Q=n.get(w.depthTexture);Q.__renderTarget=w;let rt=nt?w.depthTexture.image[0]:w.depthTexture.image;(!Q.__webglTexture||rt.width!==w.width||rt.height!==w.height)&&(rt.width=w.width,rt.height=w.height,w.depthTexture.needsUpdate=!0),nt?pt(w.depthTexture,0):ut(w.depthTexture,0);let ht=Q.__webglTexture,$=xe(w),Z=nt?i.TEXTURE_CUBE_MAP_POSITIVE_X+k:i.TEXTURE_2D,at=w.depthTexture.format===Mi?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT;if(w.depthTexture.format===xi)dt(w)?l.framebufferTexture2DMultisampleEXT(i.FRAMEBUFFER,at,Z,ht,0,$):i.framebufferTexture2D(i.FRAMEBUFFER,at,Z,ht,0);else if(w.depthTexture.format===Mi)dt(w)?l.framebufferTexture2DMultisampleEXT(i.FRAMEBUFFER,at,Z,ht,0,$):i.framebufferTexture2D(i.FRAMEBUFFER,at,Z,ht,0);else throw new Error("THREE.WebGLTextures: Unknown depthTexture format.")}function wn(R){let w=n.get(R),k=R.isWebGLCubeRenderTarget===!0;if(w.__boundDepthTexture!==R.depthTexture){let nt=R.depthTexture;if(w.__depthDisposeCallback&&w.__depthDisposeCallback(),nt){let Q=()=>{delete w.__boundDepthTexture,delete w.__depthDisposeCallback,nt.removeEventListener("dispose",Q)};nt.addEventListener("dispose",Q),w.__depthDisposeCallback=Q}w.__boundDepthTexture=nt}if(R.depthTexture&&!w.__autoAllocateDepthBuffer)if(k)for(let nt=0;nt<6;nt++)Fe(w.__webglFramebuffer[nt],R,nt);else R.texture.mipmaps.length>0?Fe(w.__webglFramebuffer[0],R,0):Fe(w.__webglFramebuffer,R,0);else if(k){w.__webglDepthbuffer=[];for(let nt=0;nt<6;nt++)if(e.bindFramebuffer(i.FRAMEBUFFER,w.__webglFramebuffer[nt]),w.__webglDepthbuffer[nt]===void 0)w.__webglDepthbuffer[nt]=i.createRenderbuffer(),Yn(w.__webglDepthbuffer[nt],R,!1);else{let Q=R.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT,rt=w.__webglDepthbuffer[nt];i.bindRenderbuffer(i.RENDERBUFFER,rt),i.framebufferRenderbuffer(i.FRAMEBUFFER,Q,i.RENDERBUFFER,rt)}}else if(R.texture.mipmaps.length>0?e.bindFramebuffer(i.FRAMEBUFFER,w.__webglFramebuffer[0]):e.bindFramebuffer(i.FRAMEBUFFER,w.__webglFramebuffer),w.__webglDepthbuffer===void 0)w.__webglDepthbuffer=i.createRenderbuffer(),Yn(w.__webglDepthbuffer,R,!1);else{let Q=R.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT,rt=w.__webglDepthbuffer;i.bindRenderbuffer(i.RENDERBUFFER,rt),i.framebufferRenderbuffer(i.FRAMEBUFFER,Q,i.RENDERBUFFER,rt)}e.bindFramebuffer(i.FRAMEBUFFER,null)}function An(R,w,k){let nt=n.get(R);w!==void 0&&ve(nt.__webglFramebuffer,R,R.texture,i.COLOR_ATTACHMENT0,i.TEXTURE_2D,0),k!==void 0&&wn(R)}function Tn(R){let w=R.texture,k=n.get(R),nt=n.get(w);R.addEventListener("dispose",I),L(R);let Q=R.textures,rt=R.isWebGLCubeRenderTarget===!0,ht=Q.length>1;if(ht||(nt.__webglTexture===void 0&&(nt.__webglTexture=i.createTexture()),nt.__version=w.version,o.memory.textures++),rt){k.__webglFramebuffer=[];for(let $=0;$<6;$++)if(w.mipmaps.length>0){k.__webglFramebuffer[$]=[];for(let Z=0;Z<w.mipmaps.length;Z++)k.__webglFramebuffer[$][Z]=i.createFramebuffer()}else k.__webglFramebuffer[$]=i.createFramebuffer()}else{if(w.mipmaps.length>0){k.__webglFramebuffer=[];for(let $=0;$<w.mipmaps.length;$++)k.__webglFramebuffer[$]=i.createFramebuffer()}else k.__webglFramebuffer=i.createFramebuffer();if(ht)for(let $=0,Z=Q.length;$<Z;$++){let at=n.get(Q[$]);at.__webglTexture===void 0&&(at.__webglTexture=i.createTexture(),o.memory.textures++)}if(R.samples>0&&dt(R)===!1){k.__webglMultisampledFramebuffer=i.createFramebuffer(),k.__webglColorRenderbuffer=[],e.bindFramebuffer(i.FRAMEBUFFER,k.__webglMultisampledFramebuffer);for(let $=0;$<Q.length;$++){let Z=Q[$];k.__webglColorRenderbuffer[$]=i.createRenderbuffer(),i.bindRenderbuffer(i.RENDERBUFFER,k.__webglColorRenderbuffer[$]);let at=r.convert(Z.format,Z.colorSpace),D=r.convert(Z.type),K=A(Z.internalFormat,at,D,Z.normalized,Z.colorSpace,R.isXRRenderTarget===!0),q=xe(R);i.renderbufferStorageMultisample(i.RENDERBUFFER,q,K,R.width,R.height),i.framebufferRenderbuffer(i.FRAMEBUFFER,i.COLOR_ATTACHMENT0+$,i.RENDERBUFFER,k.__webglColorRenderbuffer[$])}i.bindRenderbuffer(i.RENDERBUFFER,null),R.depthBuffer&&(k.__webglDepthRenderbuffer=i.createRenderbuffer(),Yn(k.__webglDepthRenderbuffer,R,!0)),e.bindFramebuffer(i.FRAMEBUFFER,null)}}if(rt){e.bindTexture(i.TEXTURE_CUBE_MAP,nt.__webglTexture),Kt(i.TEXTURE_CUBE_MAP,w);for(let $=0;$<6;$++)if(w.mipmaps.length>0)for(let Z=0;Z<w.mipmaps.length;Z++)ve(k.__webglFramebuffer[$][Z],R,w,i.COLOR_ATTACHMENT0,i.TEXTURE_CUBE_MAP_POSITIVE_X+$,Z);else ve(k.__webglFramebuffer[$],R,w,i.COLOR_ATTACHMENT0,i.TEXTURE_CUBE_MAP_POSITIVE_X+$,0);M(w)?v(i.TEXTURE_CUBE_MAP):w.mipmaps.length>0&&i.texParameteri(i.TEXTURE_CUBE_MAP,i.TEXTURE_MAX_LEVEL,w.mipmaps.length-1),e.unbindTexture()}else if(ht){for(let $=0,Z=Q.length;$<Z;$++){let at=Q[$],D=n.get(at),K=i.TEXTURE_2D;(R.isWebGL3DRenderTarget||R.isWebGLArrayRenderTarget)&&(K=R.isWebGL3DRenderTarget?i.TEXTURE_3D:i.TEXTURE_2D_ARRAY),e.bindTexture(K,D.__webglTexture),Kt(K,at),ve(k.__webglFramebuffer,R,at,i.COLOR_ATTACHMENT0+$,K,0),M(at)&&v(K)}e.unbindTexture()}else{let $=i.TEXTURE_2D;if((R.isWebGL3DRenderTarget||R.isWebGLArrayRenderTarget)&&($=R.isWebGL3DRenderTarget?i.TEXTURE_3D:i.TEXTURE_2D_ARRAY),e.bindTexture($,nt.__webglTexture),Kt($,w),w.mipmaps.length>0)for(let Z=0;Z<w.mipmaps.length;Z++)ve(k.__webglFramebuffer[Z],R,w,i.COLOR_ATTACHMENT0,$,Z);else ve(k.__webglFramebuffer,R,w,i.COLOR_ATTACHMENT0,$,0);M(w)?v($):w.mipmaps.length>0&&i.texParameteri($,i.TEXTURE_MAX_LEVEL,w.mipmaps.length-1),e.unbindTexture()}R.depthBuffer&&wn(R)}function O(R){let w=R.textures;for(let k=0,nt=w.length;k<nt;k++){let Q=w[k];if(M(Q)&&Q.mipmapsAutoUpdate===!0){let rt=S(R),ht=n.get(Q).__webglTexture;e.bindTexture(rt,ht),v(rt),e.unbindTexture()}}}let En=[];function ge(R){if(R.samples>0){if(dt(R)===!1){let w=R.textures,k=R.width,nt=R.height,Q=i.COLOR_BUFFER_BIT,rt=R.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT,ht=n.get(R),$=w.length>1;if($)for(let at=0;at<w.length;at++)e.bindFramebuffer(i.FRAMEBUFFER,ht.__webglMultisampledFramebuffer),i.framebufferRenderbuffer(i.FRAMEBUFFER,i.COLOR_ATTACHMENT0+at,i.RENDERBUFFER,null),e.bindFramebuffer(i.FRAMEBUFFER,ht.__webglFramebuffer),i.framebufferTexture2D(i.DRAW_FRAMEBUFFER,i.COLOR_ATTACHMENT0+at,i.TEXTURE_2D,null,0);e.bindFramebuffer(i.READ_FRAMEBUFFER,ht.__webglMultisampledFramebuffer),R.texture.mipmaps.length>0?e.bindFramebuffer(i.DRAW_FRAMEBUFFER,ht.__webglFramebuffer[0]):e.bindFramebuffer(i.DRAW_FRAMEBUFFER,ht.__webglFramebuffer);for(let at=0;at<w.length;at++){if(R.resolveDepthBuffer&&(R.depthBuffer&&(Q|=i.DEPTH_BUFFER_BIT),R.stencilBuffer&&R.resolveStencilBuffer&&(Q|=i.STENCIL_BUFFER_BIT)),$){i.framebufferRenderbuffer(i.READ_FRAMEBUFFER,i.COLOR_ATTACHMENT0,i.RENDERBUFFER,ht.__webglColorRenderbuffer[at]);let D=n.get(w[at]).__webglTexture;i.framebufferTexture2D(i.DRAW_FRAMEBUFFER,i.COLOR_ATTACHMENT0,i.TEXTURE_2D,D,0)}i.blitFramebuffer(0,0,k,nt,0,0,k,nt,Q,i.NEAREST),a===!0&&(En.length=0,En.push(i.COLOR_ATTACHMENT0+at),R.depthBuffer&&R.storeMultisampledDepthBuffer===!1&&En.push(rt),i.invalidateFramebuffer(i.READ_FRAMEBUFFER,En))}if(e.bindFramebuffer(i.READ_FRAMEBUFFER,null),e.bindFramebuffer(i.DRAW_FRAMEBUFFER,null),$)for(let at=0;at<w.length;at++){e.bindFramebuffer(i.FRAMEBUFFER,ht.__webglMultisampledFramebuffer),i.framebufferRenderbuffer(i.FRAMEBUFFER,i.COLOR_ATTACHMENT0+at,i.RENDERBUFFER,ht.__webglColorRenderbuffer[at]);let D=n.get(w[at]).__webglTexture;e.bindFramebuffer(i.FRAMEBUFFER,ht.__webglFramebuffer),i.framebufferTexture2D(i.DRAW_FRAMEBUFFER,i.COLOR_ATTACHMENT0+at,i.TEXTURE_2D,D,0)}e.bindFramebuffer(i.DRAW_FRAMEBUFFER,ht.__webglMultisampledFramebuffer)}else if(R.depthBuffer&&R.storeMultisampledDepthBuffer===!1&&a){let w=R.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT;i.invalidateFramebuffer(i.DRAW_FRAMEBUFFER,[w])}}}function xe(R){return Math.min(s.maxSamples,R.samples)}function dt(R){let w=n.get(R);return R.samples>0&&t.has("WEBGL_multisampled_render_to_texture")===!0&&w.__useRenderToTexture!==!1}function Ie(R){let w=o.render.frame;u.get(R)!==w&&(u.set(R,w),R.update())}function Pt(R,w){let k=R.colorSpace,nt=R.format,Q=R.type;return R.isCompressedTexture===!0||R.isVideoTexture===!0||k!==Lr&&k!==Si&&(Yt.getTransfer(k)===ne?(nt!==Mn||Q!==ln)&&Rt("WebGLTextures: sRGB encoded textures have to use RGBAFormat and UnsignedByteType."):Lt("WebGLTextures: Unsupported texture color space:",k)),w}function Ft(R){return typeof HTMLImageElement<"u"&&R instanceof HTMLImageElement?(c.width=R.naturalWidth||R.width,c.height=R.naturalHeight||R.height):typeof VideoFrame<"u"&&R instanceof VideoFrame?(c.width=R.displayWidth,c.height=R.displayHeight):(c.width=R.width,c.height=R.height),c}this.allocateTextureUnit=Nt,this.resetTextureUnits=j,this.getTextureUnits=tt,this.setTextureUnits=yt,this.setTexture2D=ut,this.setTexture2DArray=_t,this.setTexture3D=Tt,this.setTextureCube=pt,this.rebindTextures=An,this.setupRenderTarget=Tn,this.updateRenderTargetMipmap=O,this.updateMultisampleRenderTarget=ge,this.setupDepthRenderbuffer=wn,this.setupFrameBufferTexture=ve,this.useMultisampledRTT=dt,this.dispose=B}function Fv(i,t){function e(n,s=Si){let r,o=Yt.getTransfer(s);if(n===ln)return i.UNSIGNED_BYTE;if(n===Wa)return i.UNSIGNED_SHORT_4_4_4_4;if(n===Xa)return i.UNSIGNED_SHORT_5_5_5_1;if(n===Fu)return i.UNSIGNED_INT_5_9_9_9_REV;if(n===Ou)return i.UNSIGNED_INT_10F_11F_11F_REV;if(n===Du)return i.BYTE;if(n===Uu)return i.SHORT;if(n===Qs)return i.UNSIGNED_SHORT;if(n===Ha)return i.INT;if(n===Gn)return i.UNSIGNED_INT;if(n===Hn)return i.FLOAT;if(n===Wn)return i.HALF_FLOAT;if(n===Bu)return i.ALPHA;if(n===zu)return i.RGB;if(n===Mn)return i.RGBA;if(n===xi)return i.DEPTH_COMPONENT;if(n===Mi)return i.DEPTH_STENCIL;if(n===ku)return i.RED;if(n===qa)return i.RED_INTEGER;if(n===Hi)return i.RG;if(n===Ya)return i.RG_INTEGER;if(n===$a)return i.RGBA_INTEGER;if(n===Jr||n===Kr||n===Qr||n===jr)if(o===ne)if(r=t.get("WEBGL_compressed_texture_s3tc_srgb"),r!==null){if(n===Jr)return r.COMPRESSED_SRGB_S3TC_DXT1_EXT;if(n===Kr)return r.COMPRESSED_SRGB_ALPHA_S3TC_DXT1_EXT;if(n===Qr)return r.COMPRESSED_SRGB_ALPHA_S3TC_DXT3_EXT;if(n===jr)return r.COMPRESSED_SRGB_ALPHA_S3TC_DXT5_EXT}else return null;else if(r=t.get("WEBGL_compressed_texture_s3tc"),r!==null){if(n===Jr)return r.COMPRESSED_RGB_S3TC_DXT1_EXT;if(n===Kr)return r.COMPRESSED_RGBA_S3TC_DXT1_EXT;if(n===Qr)return r.COMPRESSED_RGBA_S3TC_DXT3_EXT;if(n===jr)return r.COMPRESSED_RGBA_S3TC_DXT5_EXT}else return null;if(n===Za||n===Ja||n===Ka||n===Qa)if(r=t.get("WEBGL_compressed_texture_pvrtc"),r!==null){if(n===Za)return r.COMPRESSED_RGB_PVRTC_4BPPV1_IMG;if(n===Ja)return r.COMPRESSED_RGB_PVRTC_2BPPV1_IMG;if(n===Ka)return r.COMPRESSED_RGBA_PVRTC_4BPPV1_IMG;if(n===Qa)return r.COMPRESSED_RGBA_PVRTC_2BPPV1_IMG}else return null;if(n===ja||n===tl||n===el||n===nl||n===il||n===to||n===sl)if(r=t.get("WEBGL_compressed_texture_etc"),r!==null){if(n===ja||n===tl)return o===ne?r.COMPRESSED_SRGB8_ETC2:r.COMPRESSED_RGB8_ETC2;if(n===el)return o===ne?r.COMPRESSED_SRGB8_ALPHA8_ETC2_EAC:r.COMPRESSED_RGBA8_ETC2_EAC;if(n===nl)return r.COMPRESSED_R11_EAC;if(n===il)return r.COMPRESSED_SIGNED_R11_EAC;if(n===to)return r.COMPRESSED_RG11_EAC;if(n===sl)return r.COMPRESSED_SIGNED_RG11_EAC}else return null;if(n===rl||n===ol||n===al||n===ll||n===cl||n===ul||n===hl||n===fl||n===dl||n===pl||n===ml||n===gl||n===xl||n===_l)if(r=t.get("WEBGL_compressed_texture_astc"),r!==null){if(n===rl)return o===ne?r.COMPRESSED_SRGB8_ALPHA8_ASTC_4x4_KHR:r.COMPRESSED_RGBA_ASTC_4x4_KHR;if(n===ol)return o===ne?r.COMPRESSED_SRGB8_ALPHA8_ASTC_5x4_KHR:r.COMPRESSED_RGBA_ASTC_5x4_KHR;if(n===al)return o===ne?r.COMPRESSED_SRGB8_ALPHA8_ASTC_5x5_KHR:r.COMPRESSED_RGBA_ASTC_5x5_KHR;if(n===ll)return o===ne?r.COMPRESSED_SRGB8_ALPHA8_ASTC_6x5_KHR:r.COMPRESSED_RGBA_ASTC_6x5_KHR;if(n===cl)return o===ne?r.COMPRESSED_SRGB8_ALPHA8_ASTC_6x6_KHR:r.COMPRESSED_RGBA_ASTC_6x6_KHR;if(n===ul)return o===ne?r.COMPRESSED_SRGB8_ALPHA8_ASTC_8x5_KHR:r.COMPRESSED_RGBA_ASTC_8x5_KHR;if(n===hl)return o===ne?r.COMPRESSED_SRGB8_ALPHA8_ASTC_8x6_KHR:r.COMPRESSED_RGBA_ASTC_8x6_KHR;if(n===fl)return o===ne?r.COMPRESSED_SRGB8_ALPHA8_ASTC_8x8_KHR:r.COMPRESSED_RGBA_ASTC_8x8_KHR;if(n===dl)return o===ne?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x5_KHR:r.COMPRESSED_RGBA_ASTC_10x5_KHR;if(n===pl)return o===ne?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x6_KHR:r.COMPRESSED_RGBA_ASTC_10x6_KHR;if(n===ml)return o===ne?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x8_KHR:r.COMPRESSED_RGBA_ASTC_10x8_KHR;if(n===gl)return o===ne?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x10_KHR:r.COMPRESSED_RGBA_ASTC_10x10_KHR;if(n===xl)return o===ne?r.COMPRESSED_SRGB8_ALPHA8_ASTC_12x10_KHR:r.COMPRESSED_RGBA_ASTC_12x10_KHR;if(n===_l)return o===ne?r.COMPRESSED_SRGB8_ALPHA8_ASTC_12x12_KHR:r.COMPRESSED_RGBA_ASTC_12x12_KHR}else return null;if(n===yl||n===vl||n===Ml)if(r=t.get("EXT_texture_compression_bptc"),r!==null){if(n===yl)return o===ne?r.COMPRESSED_SRGB_ALPHA_BPTC_UNORM_EXT:r.COMPRESSED_RGBA_BPTC_UNORM_EXT;if(n===vl)return r.COMPRESSED_RGB_BPTC_SIGNED_FLOAT_EXT;if(n===Ml)return r.COMPRESSED_RGB_BPTC_UNSIGNED_FLOAT_EXT}else return null;if(n===Sl||n===bl||n===eo||n===wl)if(r=t.get("EXT_texture_compression_rgtc"),r!==null){if(n===Sl)return r.COMPRESSED_RED_RGTC1_EXT;if(n===bl)return r.COMPRESSED_SIGNED_RED_RGTC1_EXT;if(n===eo)return r.COMPRESSED_RED_GREEN_RGTC2_EXT;if(n===wl)return r.COMPRESSED_SIGNED_RED_GREEN_RGTC2_EXT}else return null;return n===ps?i.UNSIGNED_INT_24_8:i[n]!==void 0?i[n]:null}return{convert:e}}var Ov=`
void main() {

	gl_Position = vec4( position, 1.0 );

}`,Bv=`
uniform sampler2DArray depthColor;
uniform float depthWidth;
uniform float depthHeight;

void main() {

	vec2 coord = vec2( gl_FragCoord.x / depthWidth, gl_FragCoord.y / depthHeight );

	if ( coord.x >= 1.0 ) {

		gl_FragDepth = texture( depthColor, vec3( coord.x - 1.0, coord.y, 1 ) ).r;

	} else {

		gl_FragDepth = texture( depthColor, vec3( coord.x, coord.y, 0 ) ).r;

	}

}`,ah=class{constructor(){this.texture=null,this.mesh=null,this.depthNear=0,this.depthFar=0}init(t,e){if(this.texture===null){let n=new Hr(t.texture);(t.depthNear!==e.depthNear||t.depthFar!==e.depthFar)&&(this.depthNear=t.depthNear,this.depthFar=t.depthFar),this.texture=n}}getMesh(t){if(this.texture!==null&&this.mesh===null){let e=t.cameras[0].viewport,n=new je({vertexShader:Ov,fragmentShader:Bv,uniforms:{depthColor:{value:this.texture},depthWidth:{value:e.z},depthHeight:{value:e.w}}});this.mesh=new de(new yi(20,20),n)}return this.mesh}reset(){this.texture=null,this.mesh=null}getDepthTexture(){return this.texture}},lh=class extends Jn{constructor(t,e){super();let n=this,s=null,r=1,o=null,l="local-floor",a=1,c=null,u=null,h=null,f=null,d=null,g=null,y=typeof XRWebGLBinding<"u",p=new ah,m={},x=e.getContextAttributes(),M=null,v=null,S=[],A=[],_=new Et,b=null,L=null,E=new xn;E.viewport=new me;let C=new xn;C.viewport=new me;let I=[E,C],U=new za,P=null,B=null;this.cameraAutoUpdate=!0,this.enabled=!1,this.isPresenting=!1,this.getController=function(J){let ut=S[J];return ut===void 0&&(ut=new Xs,S[J]=ut),ut.getTargetRaySpace()},this.getControllerGrip=function(J){let ut=S[J];return ut===void 0&&(ut=new Xs,S[J]=ut),ut.getGripSpace()},this.getHand=function(J){let ut=S[J];return ut===void 0&&(ut=new Xs,S[J]=ut),ut.getHandSpace()};function H(J){let ut=A.indexOf(J.inputSource);if(ut===-1)return;let _t=S[ut];_t!==void 0&&(_t.update(J.inputSource,J.frame,c||o),_t.dispatchEvent({type:J.type,data:J.inputSource}))}function G(){s.removeEventListener("select",H),s.removeEventListener("selectstart",H),s.removeEventListener("selectend",H),s.removeEventListener("squeeze",H),s.removeEventListener("squeezestart",H),s.removeEventListener("squeezeend",H),s.removeEventListener("end",G),s.removeEventListener("inputsourceschange",et);for(let J=0;J<S.length;J++){let ut=A[J];ut!==null&&(A[J]=null,S[J].disconnect(ut))}P=null,B=null,p.reset();for(let J in m)delete m[J];if(t.setRenderTarget(M),d=null,f=null,h=null,s=null,v=null,Nt.stop(),n.isPresenting=!1,t.setPixelRatio(b),t.setSize(_.width,_.height,!1),L!==null){let J=L.camera;J.fov=L.fov,J.zoom=L.zoom,J.updateProjectionMatrix(),L=null}n.dispatchEvent({type:"sessionend"})}this.setFramebufferScaleFactor=function(J){r=J,n.isPresenting===!0&&Rt("WebXRManager: Cannot change framebuffer scale while presenting.")},this.setReferenceSpaceType=function(J){l=J,n.isPresenting===!0&&Rt("WebXRManager: Cannot change reference space type while presenting.")},this.getReferenceSpace=function(){return c||o},this.setReferenceSpace=function(J){c=J},this.getBaseLayer=function(){return f!==null?f:d},this.getBinding=function(){return h===null&&y&&(h=new XRWebGLBinding(s,e)),h},this.getFrame=function(){return g},this.getSession=function(){return s},this.setSession=async function(J){if(s=J,s!==null){if(M=t.getRenderTarget(),s.addEventListener("select",H),s.addEventListener("selectstart",H),s.addEventListener("selectend",H),s.addEventListener("squeeze",H),s.addEventListener("squeezestart",H),s.addEventListener("squeezeend",H),s.addEventListener("end",G),s.addEventListener("inputsourceschange",et),x.xrCompatible!==!0&&await e.makeXRCompatible(),b=t.getPixelRatio(),t.getSize(_),y&&"createProjectionLayer"in XRWebGLBinding.prototype){let _t=null,Tt=null,pt=null;x.depth&&(pt=x.stencil?e.DEPTH24_STENCIL8:e.DEPTH_COMPONENT24,_t=x.stencil?Mi:xi,Tt=x.stencil?ps:Gn);let Ut={colorFormat:e.RGBA8,depthFormat:pt,scaleFactor:r};h=this.getBinding(),f=h.createProjectionLayer(Ut),s.updateRenderState({layers:[f]}),t.setPixelRatio(1),t.setSize(f.textureWidth,f.textureHeight,!1),v=new on(f.textureWidth,f.textureHeight,{format:Mn,type:ln,depthTexture:new _i(f.textureWidth,f.textureHeight,Tt,void 0,void 0,void 0,void 0,void 0,void 0,_t),stencilBuffer:x.stencil,colorSpace:t.outputColorSpace,samples:x.antialias?4:0,resolveDepthBuffer:f.ignoreDepthValues===!1,resolveStencilBuffer:f.ignoreDepthValues===!1,storeMultisampledDepthBuffer:f.ignoreDepthValues===!1,storeMultisampledStencilBuffer:f.ignoreDepthValues===!1})}else{let _t={antialias:x.antialias,alpha:!0,depth:x.depth,stencil:x.stencil,framebufferScaleFactor:r};d=new XRWebGLLayer(s,e,_t),s.updateRenderState({baseLayer:d}),t.setPixelRatio(1),t.setSize(d.framebufferWidth,d.framebufferHeight,!1),v=new on(d.framebufferWidth,d.framebufferHeight,{format:Mn,type:ln,colorSpace:t.outputColorSpace,stencilBuffer:x.stencil,resolveDepthBuffer:d.ignoreDepthValues===!1,resolveStencilBuffer:d.ignoreDepthValues===!1,storeMultisampledDepthBuffer:d.ignoreDepthValues===!1,storeMultisampledStencilBuffer:d.ignoreDepthValues===!1})}v.isXRRenderTarget=!0,this.setFoveation(a),c=null,o=await s.requestReferenceSpace(l),Nt.setContext(s),Nt.start(),n.isPresenting=!0,n.dispatchEvent({type:"sessionstart"})}},this.getEnvironmentBlendMode=function(){if(s!==null)return s.environmentBlendMode},this.getDepthTexture=function(){return p.getDepthTexture()};function et(J){for(let ut=0;ut<J.removed.length;ut++){let _t=J.removed[ut],Tt=A.indexOf(_t);Tt>=0&&(A[Tt]=null,S[Tt].disconnect(_t))}for(let ut=0;ut<J.added.length;ut++){let _t=J.added[ut],Tt=A.indexOf(_t);if(Tt===-1){for(let Ut=0;Ut<S.length;Ut++)if(Ut>=A.length){A.push(_t),Tt=Ut;break}else if(A[Ut]===null){A[Ut]=_t,Tt=Ut;break}if(Tt===-1)break}let pt=S[Tt];pt&&pt.connect(_t)}}function X(J,ut){ut===null?J.matrixWorld.copy(J.matrix):J.matrixWorld.multiplyMatrices(ut.matrixWorld,J.matrix),J.matrixWorldInverse.copy(J.matrixWorld).invert()}this.updateCamera=function(J){if(s===null)return;let ut=J.near,_t=J.far;p.texture!==null&&(p.depthNear>0&&(ut=p.depthNear),p.depthFar>0&&(_t=p.depthFar)),U.near=C.near=E.near=ut,U.far=C.far=E.far=_t,(P!==U.near||B!==U.far)&&(s.updateRenderState({depthNear:U.near,depthFar:U.far}),P=U.near,B=U.far),U.layers.mask=J.layers.mask|6,E.layers.mask=U.layers.mask&-5,C.layers.mask=U.layers.mask&-3;let Tt=J.parent,pt=U.cameras;X(U,Tt);for(let Ut=0;Ut<pt.length;Ut++)X(pt[Ut],Tt);U.projectionMatrix.copy(E.projectionMatrix),U.projectionMatrixInverse.copy(E.projectionMatrixInverse),L===null&&J.isPerspectiveCamera&&(L={camera:J,fov:J.fov,zoom:J.zoom}),j(J,U,Tt)};function j(J,ut,_t){_t===null?J.matrix.copy(ut.matrixWorld):(J.matrix.copy(_t.matrixWorld),J.matrix.invert(),J.matrix.multiply(ut.matrixWorld)),J.matrix.decompose(J.position,J.quaternion,J.scale),J.updateMatrixWorld(!0),J.projectionMatrix.copy(ut.projectionMatrix),J.projectionMatrixInverse.copy(ut.projectionMatrixInverse),J.isPerspectiveCamera&&(J.fov=ga*2*Math.atan(1/J.projectionMatrix.elements[5]),J.zoom=1)}this.getCamera=function(){return U},this.getFoveation=function(){if(!(f===null&&d===null))return a},this.setFoveation=function(J){a=J,f!==null&&(f.fixedFoveation=J),d!==null&&d.fixedFoveation!==void 0&&(d.fixedFoveation=J)},this.hasDepthSensing=function(){return p.texture!==null},this.getDepthSensingMesh=function(){return p.getMesh(U)},this.getCameraTexture=function(J){return m[J]};let tt=null;function yt(J,ut){if(u=ut.getViewerPose(c||o),g=ut,u!==null){let _t=u.views;d!==null&&(t.setRenderTargetFramebuffer(v,d.framebuffer),t.setRenderTarget(v));let Tt=!1;_t.length!==U.cameras.length&&(U.cameras.length=0,Tt=!0);for(let Ct=0;Ct<_t.length;Ct++){let Kt=_t[Ct],ae=null;if(d!==null)ae=d.getViewport(Kt);else{let Ve=h.getViewSubImage(f,Kt);ae=Ve.viewport,Ct===0&&(t.setRenderTargetTextures(v,Ve.colorTexture,Ve.depthStencilTexture),t.setRenderTarget(v))}let Wt=I[Ct];Wt===void 0&&(Wt=new xn,Wt.layers.enable(Ct),Wt.viewport=new me,I[Ct]=Wt),Wt.matrix.fromArray(Kt.transform.matrix),Wt.matrix.decompose(Wt.position,Wt.quaternion,Wt.scale),Wt.projectionMatrix.fromArray(Kt.projectionMatrix),Wt.projectionMatrixInverse.copy(Wt.projectionMatrix).invert(),Wt.viewport.set(ae.x,ae.y,ae.width,ae.height),Ct===0&&(U.matrix.copy(Wt.matrix),U.matrix.decompose(U.position,U.quaternion,U.scale)),Tt===!0&&U.cameras.push(Wt)}let pt=s.enabledFeatures;if(pt&&pt.includes("depth-sensing")&&s.depthUsage=="gpu-optimized"&&y){h=n.getBinding();let Ct=h.getDepthInformation(_t[0]);Ct&&Ct.isValid&&Ct.texture&&p.init(Ct,s.renderState)}if(pt&&pt.includes("camera-access")&&y){t.state.unbindTexture(),h=n.getBinding();for(let Ct=0;Ct<_t.length;Ct++){let Kt=_t[Ct].camera;if(Kt){let ae=m[Kt];ae||(ae=new Hr,m[Kt]=ae);let Wt=h.getCameraImage(Kt);ae.sourceTexture=Wt}}}}for(let _t=0;_t<S.length;_t++){let Tt=A[_t],pt=S[_t];Tt!==null&&pt!==void 0&&pt.update(Tt,ut,c||o)}tt&&tt(J,ut),ut.detectedPlanes&&n.dispatchEvent({type:"planesdetected",data:ut}),g=null}let Nt=new up;Nt.setAnimationLoop(yt),this.setAnimationLoop=function(J){tt=J},this.dispose=function(){}}},zv=new zt,vp=new Dt;vp.set(-1,0,0,0,1,0,0,0,1);function kv(i,t){function e(p,m){p.matrixAutoUpdate===!0&&p.updateMatrix(),m.value.copy(p.matrix)}function n(p,m){m.color.getRGB(p.fogColor.value,Zu(i)),m.isFog?(p.fogNear.value=m.near,p.fogFar.value=m.far):m.isFogExp2&&(p.fogDensity.value=m.density)}function s(p,m,x,M,v){m.isNodeMaterial?m.uniformsNeedUpdate=!1:m.isMeshBasicMaterial?r(p,m):m.isMeshLambertMaterial?(r(p,m),m.envMap&&(p.envMapIntensity.value=m.envMapIntensity)):m.isMeshToonMaterial?(r(p,m),h(p,m)):m.isMeshPhongMaterial?(r(p,m),u(p,m),m.envMap&&(p.envMapIntensity.value=m.envMapIntensity)):m.isMeshStandardMaterial?(r(p,m),f(p,m),m.isMeshPhysicalMaterial&&d(p,m,v)):m.isMeshMatcapMaterial?(r(p,m),g(p,m)):m.isMeshDepthMaterial?r(p,m):m.isMeshDistanceMaterial?(r(p,m),y(p,m)):m.isMeshNormalMaterial?r(p,m):m.isLineBasicMaterial?(o(p,m),m.isLineDashedMaterial&&l(p,m)):m.isPointsMaterial?a(p,m,x,M):m.isSpriteMaterial?c(p,m):m.isShadowMaterial?(p.color.value.copy(m.color),p.opacity.value=m.opacity):m.isShaderMaterial&&(m.uniformsNeedUpdate=!1)}function r(p,m){p.opacity.value=m.opacity,m.color&&p.diffuse.value.copy(m.color),m.emissive&&p.emissive.value.copy(m.emissive).multiplyScalar(m.emissiveIntensity),m.map&&(p.map.value=m.map,e(m.map,p.mapTransform)),m.alphaMap&&(p.alphaMap.value=m.alphaMap,e(m.alphaMap,p.alphaMapTransform)),m.bumpMap&&(p.bumpMap.value=m.bumpMap,e(m.bumpMap,p.bumpMapTransform),p.bumpScale.value=m.bumpScale,m.side===qe&&(p.bumpScale.value*=-1)),m.normalMap&&(p.normalMap.value=m.normalMap,e(m.normalMap,p.normalMapTransform),p.normalScale.value.copy(m.normalScale),m.side===qe&&p.normalScale.value.negate()),m.displacementMap&&(p.displacementMap.value=m.displacementMap,e(m.displacementMap,p.displacementMapTransform),p.displacementScale.value=m.displacementScale,p.displacementBias.value=m.displacementBias),m.emissiveMap&&(p.emissiveMap.value=m.emissiveMap,e(m.emissiveMap,p.emissiveMapTransform)),m.specularMap&&(p.specularMap.value=m.specularMap,e(m.specularMap,p.specularMapTransform)),m.alphaTest>0&&(p.alphaTest.value=m.alphaTest);let x=t.get(m),M=x.envMap,v=x.envMapRotation;M&&(p.envMap.value=M,p.envMapRotation.value.setFromMatrix4(zv.makeRotationFromEuler(v)).transpose(),M.isCubeTexture&&M.isRenderTargetTexture===!1&&p.envMapRotation.value.premultiply(vp),p.reflectivity.value=m.reflectivity,p.ior.value=m.ior,p.refractionRatio.value=m.refractionRatio),m.lightMap&&(p.lightMap.value=m.lightMap,p.lightMapIntensity.value=m.lightMapIntensity,e(m.lightMap,p.lightMapTransform)),m.aoMap&&(p.aoMap.value=m.aoMap,p.aoMapIntensity.value=m.aoMapIntensity,e(m.aoMap,p.aoMapTransform))}function o(p,m){p.diffuse.value.copy(m.color),p.opacity.value=m.opacity,m.map&&(p.map.value=m.map,e(m.map,p.mapTransform))}function l(p,m){p.dashSize.value=m.dashSize,p.totalSize.value=m.dashSize+m.gapSize,p.scale.value=m.scale}function a(p,m,x,M){p.diffuse.value.copy(m.color),p.opacity.value=m.opacity,p.size.value=m.size*x,p.scale.value=M*.5,m.map&&(p.map.value=m.map,e(m.map,p.uvTransform)),m.alphaMap&&(p.alphaMap.value=m.alphaMap,e(m.alphaMap,p.alphaMapTransform)),m.alphaTest>0&&(p.alphaTest.value=m.alphaTest)}function c(p,m){p.diffuse.value.copy(m.color),p.opacity.value=m.opacity,p.rotation.value=m.rotation,m.map&&(p.map.value=m.map,e(m.map,p.mapTransform)),m.alphaMap&&(p.alphaMap.value=m.alphaMap,e(m.alphaMap,p.alphaMapTransform)),m.alphaTest>0&&(p.alphaTest.value=m.alphaTest)}function u(p,m){p.specular.value.copy(m.specular),p.shininess.value=Math.max(m.shininess,1e-4)}function h(p,m){m.gradientMap&&(p.gradientMap.value=m.gradientMap)}function f(p,m){p.metalness.value=m.metalness,m.metalnessMap&&(p.metalnessMap.value=m.metalnessMap,e(m.metalnessMap,p.metalnessMapTransform)),p.roughness.value=m.roughness,m.roughnessMap&&(p.roughnessMap.value=m.roughnessMap,e(m.roughnessMap,p.roughnessMapTransform)),m.envMap&&(p.envMapIntensity.value=m.envMapIntensity)}function d(p,m,x){p.ior.value=m.ior,m.diffuseRoughness>0&&(p.diffuseRoughness.value=m.diffuseRoughness,m.diffuseRoughnessMap&&(p.diffuseRoughnessMap.value=m.diffuseRoughnessMap,e(m.diffuseRoughnessMap,p.diffuseRoughnessMapTransform))),m.sheen>0&&(p.sheenColor.value.copy(m.sheenColor).multiplyScalar(m.sheen),p.sheenRoughness.value=m.sheenRoughness,m.sheenColorMap&&(p.sheenColorMap.value=m.sheenColorMap,e(m.sheenColorMap,p.sheenColorMapTransform)),m.sheenRoughnessMap&&(p.sheenRoughnessMap.value=m.sheenRoughnessMap,e(m.sheenRoughnessMap,p.sheenRoughnessMapTransform))),m.clearcoat>0&&(p.clearcoat.value=m.clearcoat,p.clearcoatRoughness.value=m.clearcoatRoughness,m.clearcoatMap&&(p.clearcoatMap.value=m.clearcoatMap,e(m.clearcoatMap,p.clearcoatMapTransform)),m.clearcoatRoughnessMap&&(p.clearcoatRoughnessMap.value=m.clearcoatRoughnessMap,e(m.clearcoatRoughnessMap,p.clearcoatRoughnessMapTransform)),m.clearcoatNormalMap&&(p.clearcoatNormalMap.value=m.clearcoatNormalMap,e(m.clearcoatNormalMap,p.clearcoatNormalMapTransform),p.clearcoatNormalScale.value.copy(m.clearcoatNormalScale),m.side===qe&&p.clearcoatNormalScale.value.negate())),m.dispersion>0&&(p.dispersion.value=m.dispersion),m.retroreflectivity>0&&(p.retroreflectivity.value=m.retroreflectivity),m.iridescence>0&&(p.iridescence.value=m.iridescence,p.iridescenceIOR.value=m.iridescenceIOR,p.iridescenceThicknessMinimum.value=m.iridescenceThicknessMinimum,p.iridescenceThicknessMaximum.value=m.iridescenceThicknessMaximum,m.iridescenceMap&&(p.iridescenceMap.value=m.iridescenceMap,e(m.iridescenceMap,p.iridescenceMapTransform)),m.iridescenceThicknessMap&&(p.iridescenceThicknessMap.value=m.iridescenceThicknessMap,e(m.iridescenceThicknessMap,p.iridescenceThicknessMapTransform))),m.transmission>0&&(p.transmission.value=m.transmission,p.transmissionSamplerMap.value=x.texture,p.transmissionSamplerSize.value.set(x.width,x.height),m.transmissionMap&&(p.transmissionMap.value=m.transmissionMap,e(m.transmissionMap,p.transmissionMapTransform)),p.thickness.value=m.thickness,m.thicknessMap&&(p.thicknessMap.value=m.thicknessMap,e(m.thicknessMap,p.thicknessMapTransform)),p.attenuationDistance.value=m.attenuationDistance,p.attenuationColor.value.copy(m.attenuationColor)),m.anisotropy>0&&(p.anisotropyVector.value.set(m.anisotropy*Math.cos(m.anisotropyRotation),m.anisotropy*Math.sin(m.anisotropyRotation)),m.anisotropyMap&&(p.anisotropyMap.value=m.anisotropyMap,e(m.anisotropyMap,p.anisotropyMapTransform))),p.specularIntensity.value=m.specularIntensity,p.specularColor.value.copy(m.specularColor),m.specularColorMap&&(p.specularColorMap.value=m.specularColorMap,e(m.specularColorMap,p.specularColorMapTransform)),m.specularIntensityMap&&(p.specularIntensityMap.value=m.specularIntensityMap,e(m.specularIntensityMap,p.specularIntensityMapTransform))}function g(p,m){m.matcap&&(p.matcap.value=m.matcap)}function y(p,m){let x=t.get(m).light;p.referencePosition.value.setFromMatrixPosition(x.matrixWorld),p.nearDistance.value=x.shadow.camera.near,p.farDistance.value=x.shadow.camera.far}return{refreshFogUniforms:n,refreshMaterialUniforms:s}}function Vv(i,t,e,n){let s={},r={};function o(x,M){let v=M.program;n.uniformBlockBinding(x,v,s[x.id])}function l(x,M){let v=s[x.id];v===void 0&&(g(x),v=a(x),s[x.id]=v,x.addEventListener("dispose",p));let S=M.program;n.updateUBOMapping(x,S);let A=t.render.frame;r[x.id]!==A&&(c(x),r[x.id]=A)}function a(x){let M=i.createBuffer(),v=x.__size,S=x.usage;return i.bindBuffer(i.UNIFORM_BUFFER,M),i.bufferData(i.UNIFORM_BUFFER,v,S),i.bindBuffer(i.UNIFORM_BUFFER,null),M}function c(x){let M=s[x.id],v=x.uniforms,S=x.__cache;i.bindBuffer(i.UNIFORM_BUFFER,M);for(let A=0,_=v.length;A<_;A++){let b=v[A];if(Array.isArray(b))for(let L=0,E=b.length;L<E;L++)u(b[L],A,L,S);else u(b,A,0,S)}i.bindBuffer(i.UNIFORM_BUFFER,null)}function u(x,M,v,S){if(f(x,M,v,S)===!0){let A=x.__offset,_=x.value;if(Array.isArray(_)){let b=0;for(let L=0;L<_.length;L++){let E=_[L],C=y(E,!0);h(E,x.__data,b),b+=C.storage/Float32Array.BYTES_PER_ELEMENT}}else h(_,x.__data,0);i.bufferSubData(i.UNIFORM_BUFFER,A,x.__data)}}function h(x,M,v){typeof x=="number"||typeof x=="boolean"?M[v]=x:x.isMatrix3?(M[v]=x.elements[0],M[v+1]=x.elements[1],M[v+2]=x.elements[2],M[v+3]=0,M[v+4]=x.elements[3],M[v+5]=x.elements[4],M[v+6]=x.elements[5],M[v+7]=0,M[v+8]=x.elements[6],M[v+9]=x.elements[7],M[v+10]=x.elements[8],M[v+11]=0):ArrayBuffer.isView(x)?M.set(x.subarray(0,M.length-v),v):x.toArray(M,v)}function f(x,M,v,S){let A=x.value,_=M+"_"+v;if(Array.isArray(A)){S[_]===void 0&&(S[_]=[]);let b=S[_],L=!1;for(let E=0;E<A.length;E++)d(A[E],b,E)===!0&&(L=!0);return L}return d(A,S,_)}function d(x,M,v){if(M[v]===void 0)return typeof x=="number"||typeof x=="boolean"?M[v]=x:ArrayBuffer.isView(x)?M[v]=x.slice():M[v]=x.clone(),!0;{let S=M[v];if(typeof x=="number"||typeof x=="boolean"){if(S!==x)return M[v]=x,!0}else{if(ArrayBuffer.isView(x))return!0;if(S.equals(x)===!1)return S.copy(x),!0}}return!1}function g(x){let M=x.uniforms,v=0,S=16;for(let _=0,b=M.length;_<b;_++){let L=Array.isArray(M[_])?M[_]:[M[_]];for(let E=0,C=L.length;E<C;E++){let I=L[E],U=Array.isArray(I.value)?I.value:[I.value],P=Array.isArray(M[_])||Array.isArray(I.value),B=v;for(let G=0,et=U.length;G<et;G++){let X=U[G],j=y(X,P),tt=v%S,yt=tt%j.boundary,Nt=tt+yt;v+=yt,Nt!==0&&S-Nt<j.storage&&(v+=S-Nt),G===0&&(B=v),v+=j.storage}let H=I.type==="int"?Int32Array:I.type==="uint"?Uint32Array:Float32Array;I.__data=new H((v-B)/Float32Array.BYTES_PER_ELEMENT),I.__offset=B}}let A=v%S;return A>0&&(v+=S-A),x.__size=v,x.__cache={},this}function y(x,M){let v={boundary:0,storage:0};return typeof x=="number"||typeof x=="boolean"?(v.boundary=4,v.storage=4):x.isVector2?(v.boundary=8,v.storage=8):x.isVector3||x.isColor?(v.boundary=16,v.storage=12):x.isVector4?(v.boundary=16,v.storage=16):x.isMatrix3?(v.boundary=16,v.storage=48):x.isMatrix4?(v.boundary=16,v.storage=64):x.isTexture?Rt("WebGLRenderer: Texture samplers can not be part of an uniforms group."):ArrayBuffer.isView(x)?(v.boundary=16,v.storage=x.byteLength):Rt("WebGLRenderer: Unsupported uniform value type.",x),M===!0&&(v.boundary=16,v.storage=Math.ceil(v.storage/16)*16),v}function p(x){let M=x.target;M.removeEventListener("dispose",p),i.deleteBuffer(s[M.id]),delete s[M.id],delete r[M.id]}function m(){for(let x in s)i.deleteBuffer(s[x]);s={},r={}}return{bind:o,update:l,dispose:m}}var Gv=new Uint16Array([12469,15057,12620,14925,13266,14620,13807,14376,14323,13990,14545,13625,14713,13328,14840,12882,14931,12528,14996,12233,15039,11829,15066,11525,15080,11295,15085,10976,15082,10705,15073,10495,13880,14564,13898,14542,13977,14430,14158,14124,14393,13732,14556,13410,14702,12996,14814,12596,14891,12291,14937,11834,14957,11489,14958,11194,14943,10803,14921,10506,14893,10278,14858,9960,14484,14039,14487,14025,14499,13941,14524,13740,14574,13468,14654,13106,14743,12678,14818,12344,14867,11893,14889,11509,14893,11180,14881,10751,14852,10428,14812,10128,14765,9754,14712,9466,14764,13480,14764,13475,14766,13440,14766,13347,14769,13070,14786,12713,14816,12387,14844,11957,14860,11549,14868,11215,14855,10751,14825,10403,14782,10044,14729,9651,14666,9352,14599,9029,14967,12835,14966,12831,14963,12804,14954,12723,14936,12564,14917,12347,14900,11958,14886,11569,14878,11247,14859,10765,14828,10401,14784,10011,14727,9600,14660,9289,14586,8893,14508,8533,15111,12234,15110,12234,15104,12216,15092,12156,15067,12010,15028,11776,14981,11500,14942,11205,14902,10752,14861,10393,14812,9991,14752,9570,14682,9252,14603,8808,14519,8445,14431,8145,15209,11449,15208,11451,15202,11451,15190,11438,15163,11384,15117,11274,15055,10979,14994,10648,14932,10343,14871,9936,14803,9532,14729,9218,14645,8742,14556,8381,14461,8020,14365,7603,15273,10603,15272,10607,15267,10619,15256,10631,15231,10614,15182,10535,15118,10389,15042,10167,14963,9787,14883,9447,14800,9115,14710,8665,14615,8318,14514,7911,14411,7507,14279,7198,15314,9675,15313,9683,15309,9712,15298,9759,15277,9797,15229,9773,15166,9668,15084,9487,14995,9274,14898,8910,14800,8539,14697,8234,14590,7790,14479,7409,14367,7067,14178,6621,15337,8619,15337,8631,15333,8677,15325,8769,15305,8871,15264,8940,15202,8909,15119,8775,15022,8565,14916,8328,14804,8009,14688,7614,14569,7287,14448,6888,14321,6483,14088,6171,15350,7402,15350,7419,15347,7480,15340,7613,15322,7804,15287,7973,15229,8057,15148,8012,15046,7846,14933,7611,14810,7357,14682,7069,14552,6656,14421,6316,14251,5948,14007,5528,15356,5942,15356,5977,15353,6119,15348,6294,15332,6551,15302,6824,15249,7044,15171,7122,15070,7050,14949,6861,14818,6611,14679,6349,14538,6067,14398,5651,14189,5311,13935,4958,15359,4123,15359,4153,15356,4296,15353,4646,15338,5160,15311,5508,15263,5829,15188,6042,15088,6094,14966,6001,14826,5796,14678,5543,14527,5287,14377,4985,14133,4586,13869,4257,15360,1563,15360,1642,15358,2076,15354,2636,15341,3350,15317,4019,15273,4429,15203,4732,15105,4911,14981,4932,14836,4818,14679,4621,14517,4386,14359,4156,14083,3795,13808,3437,15360,122,15360,137,15358,285,15355,636,15344,1274,15322,2177,15281,2765,15215,3223,15120,3451,14995,3569,14846,3567,14681,3466,14511,3305,14344,3121,14037,2800,13753,2467,15360,0,15360,1,15359,21,15355,89,15346,253,15325,479,15287,796,15225,1148,15133,1492,15008,1749,14856,1882,14685,1886,14506,1783,14324,1608,13996,1398,13702,1183]),jn=null;function Hv(){return jn===null&&(jn=new qs(Gv,16,16,Hi,Wn),jn.name="DFG_LUT",jn.minFilter=rn,jn.magFilter=rn,jn.wrapS=Zn,jn.wrapT=Zn,jn.generateMipmaps=!1,jn.needsUpdate=!0),jn}var Cl=class{constructor(t={}){let{canvas:e=Dd(),context:n=null,depth:s=!0,stencil:r=!1,alpha:o=!1,antialias:l=!1,premultipliedAlpha:a=!0,preserveDrawingBuffer:c=!1,powerPreference:u="default",failIfMajorPerformanceCaveat:h=!1,reversedDepthBuffer:f=!1,outputBufferType:d=ln}=t;this.isWebGLRenderer=!0;let g;if(n!==null){if(typeof WebGLRenderingContext<"u"&&n instanceof WebGLRenderingContext)throw new Error("THREE.WebGLRenderer: WebGL 1 is not supported since r163.");g=n.getContextAttributes().alpha}else g=o;let y=d,p=new Set([$a,Ya,qa]),m=new Set([ln,Gn,Qs,ps,Wa,Xa]),x=new Uint32Array(4),M=new Int32Array(4),v={textures:[],min:[],max:[],resolution:[]},S=null,A=null,_=[],b=[],L=null;this.domElement=e,this.debug={checkShaderErrors:!0,diagnostics:{keywords:!1},onShaderError:null},this.autoClear=!0,this.autoClearColor=!0,this.autoClearDepth=!0,this.autoClearStencil=!0,this.sortObjects=!0,this.clippingPlanes=[],this.localClippingEnabled=!1,this.toneMapping=Qn,this.toneMappingExposure=1,this.transmissionResolutionScale=1;let E=this,C=!1,I=null,U=null,P=null,B=null;this._outputColorSpace=gn;let H=0,G=0,et=null,X=-1,j=null,tt=new me,yt=new me,Nt=null,J=new Zt(0),ut=0,_t=e.width,Tt=e.height,pt=1,Ut=null,Se=null,Ct=new me(0,0,_t,Tt),Kt=new me(0,0,_t,Tt),ae=!1,Wt=new us,Ve=new Ma,Pe=!1,un=!1,ve=new zt,Yn=new N,Fe=new me,wn={background:null,fog:null,environment:null,overrideMaterial:null,isScene:!0},An=!1;function Tn(){return et===null?pt:1}let O=n;function En(T,F){return e.getContext(T,F)}let ge,xe,dt,Ie,Pt,Ft,R,w,k,nt,Q,rt,ht,$,Z,at,D,K,q,lt,st,ot,wt;try{let T={alpha:!0,depth:s,stencil:r,antialias:l,premultipliedAlpha:a,preserveDrawingBuffer:c,powerPreference:u,failIfMajorPerformanceCaveat:h};if("setAttribute"in e&&e.setAttribute("data-engine",`three.js r${"187"}`),e.addEventListener("webglcontextlost",At,!1),e.addEventListener("webglcontextrestored",kt,!1),e.addEventListener("webglcontextcreationerror",mt,!1),O===null){let F="webgl2";if(O=En(F,T),O===null)throw En(F)?new Error("THREE.WebGLRenderer: Error creating WebGL context with your selected attributes."):new Error("THREE.WebGLRenderer: Error creating WebGL context.")}Vt()}catch(T){throw e.removeEventListener("webglcontextlost",At,!1),e.removeEventListener("webglcontextrestored",kt,!1),e.removeEventListener("webglcontextcreationerror",mt,!1),Lt("WebGLRenderer: "+T.message),T}function Vt(){ge=new ty(O),ge.init(),st=new Fv(O,ge),xe=new H_(O,ge,t,st),dt=new Dv(O,ge),xe.reversedDepthBuffer&&f&&dt.buffers.depth.setReversed(!0),U=O.createFramebuffer(),P=O.createFramebuffer(),B=O.createFramebuffer(),Ie=new iy(O),Pt=new vv,Ft=new Uv(O,ge,dt,Pt,xe,st,Ie),R=new j_(E),w=new r0(O),ot=new V_(O,w),k=new ey(O,w,Ie,ot),nt=new ry(O,k,w,ot,Ie),K=new sy(O,xe,Ft),Z=new W_(Pt),Q=new yv(E,R,ge,xe,ot,Z),rt=new kv(E,Pt),ht=new Sv,$=new Rv(ge),D=new k_(E,R,dt,nt,g,a),at=new Nv(E,nt,xe),wt=new Vv(O,Ie,xe,dt),q=new G_(O,ge,Ie),lt=new ny(O,ge,Ie),Ie.programs=Q.programs,E.capabilities=xe,E.extensions=ge,E.properties=Pt,E.renderLists=ht,E.shadowMap=at,E.state=dt,E.info=Ie}y!==ln&&(L=new ay(y,e.width,e.height,l,s,r));let it=new lh(E,O);this.xr=it,this.getContext=function(){return O},this.getContextAttributes=function(){return O.getContextAttributes()},this.forceContextLoss=function(){let T=ge.get("WEBGL_lose_context");T&&T.loseContext()},this.forceContextRestore=function(){let T=ge.get("WEBGL_lose_context");T&&T.restoreContext()},this.getPixelRatio=function(){return pt},this.setPixelRatio=function(T){T!==void 0&&(pt=T,this.setSize(_t,Tt,!1))},this.getSize=function(T){return T.set(_t,Tt)},this.setSize=function(T,F,W=!0){if(it.isPresenting){Rt("WebGLRenderer: Can't change size while VR device is presenting.");return}_t=T,Tt=F,e.width=Math.floor(T*pt),e.height=Math.floor(F*pt),W===!0&&(e.style.width=T+"px",e.style.height=F+"px"),L!==null&&L.setSize(e.width,e.height),this.setViewport(0,0,T,F)},this.getDrawingBufferSize=function(T){return T.set(_t*pt,Tt*pt).floor()},this.setDrawingBufferSize=function(T,F,W){_t=T,Tt=F,pt=W,e.width=Math.floor(T*W),e.height=Math.floor(F*W),this.setViewport(0,0,T,F)},this.setEffects=function(T){if(y===ln){Lt("WebGLRenderer: setEffects() requires outputBufferType set to HalfFloatType or FloatType.");return}if(T){for(let F=0;F<T.length;F++)if(T[F].isOutputPass===!0){Rt("WebGLRenderer: OutputPass is not needed in setEffects(). Tone mapping and color space conversion are applied automatically.");break}}L.setEffects(T||[])},this.getCurrentViewport=function(T){return T.copy(tt)},this.getViewport=function(T){return T.copy(Ct)},this.setViewport=function(T,F,W,z){T.isVector4?Ct.set(T.x,T.y,T.z,T.w):Ct.set(T,F,W,z),dt.viewport(tt.copy(Ct).multiplyScalar(Tn()).round())},this.getScissor=function(T){return T.copy(Kt)},this.setScissor=function(T,F,W,z){T.isVector4?Kt.set(T.x,T.y,T.z,T.w):Kt.set(T,F,W,z),dt.scissor(yt.copy(Kt).multiplyScalar(Tn()).round())},this.getScissorTest=function(){return ae},this.setScissorTest=function(T){dt.setScissorTest(ae=T)},this.setOpaqueSort=function(T){Ut=T},this.setTransparentSort=function(T){Se=T},this.getClearColor=function(T){return T.copy(D.getClearColor())},this.setClearColor=function(){D.setClearColor(...arguments)},this.getClearAlpha=function(){return D.getClearAlpha()},this.setClearAlpha=function(){D.setClearAlpha(...arguments)},this.clear=function(T=!0,F=!0,W=!0){let z=0;if(T){let V=!1;if(et!==null){let ft=et.texture.format;V=p.has(ft)}if(V){let ft=et.texture.type,vt=m.has(ft),ct=D.getClearColor(),xt=D.getClearAlpha(),bt=ct.r,Ot=ct.g,Xt=ct.b;vt?(x[0]=bt,x[1]=Ot,x[2]=Xt,x[3]=xt,O.clearBufferuiv(O.COLOR,0,x)):(M[0]=bt,M[1]=Ot,M[2]=Xt,M[3]=xt,O.clearBufferiv(O.COLOR,0,M))}else z|=O.COLOR_BUFFER_BIT}F&&(z|=O.DEPTH_BUFFER_BIT,this.state.buffers.depth.setMask(!0)),W&&(z|=O.STENCIL_BUFFER_BIT,this.state.buffers.stencil.setMask(4294967295)),z!==0&&O.clear(z)},this.clearColor=function(){this.clear(!0,!1,!1)},this.clearDepth=function(){this.clear(!1,!0,!1)},this.clearStencil=function(){this.clear(!1,!1,!0)},this.setNodesHandler=function(T){T.setRenderer(this),I=T},this.dispose=function(){e.removeEventListener("webglcontextlost",At,!1),e.removeEventListener("webglcontextrestored",kt,!1),e.removeEventListener("webglcontextcreationerror",mt,!1),D.dispose(),ht.dispose(),$.dispose(),Ft.dispose(),Pt.dispose(),R.dispose(),nt.dispose(),k.dispose(),ot.dispose(),wt.dispose(),Q.dispose(),it.dispose(),it.removeEventListener("sessionstart",Gh),it.removeEventListener("sessionend",Hh),Ki.stop()};function At(T){T.preventDefault(),Yu("WebGLRenderer: Context Lost."),C=!0}function kt(){Yu("WebGLRenderer: Context Restored."),C=!1;let T=Ie.autoReset,F=at.enabled,W=at.autoUpdate,z=at.needsUpdate,V=at.type;Vt(),Ie.autoReset=T,at.enabled=F,at.autoUpdate=W,at.needsUpdate=z,at.type=V}function mt(T){Lt("WebGLRenderer: A WebGL context could not be created. Reason: ",T.statusMessage)}function se(T){let F=T.target;F.removeEventListener("dispose",se),Oe(F)}function Oe(T){Ai(T),Pt.remove(T)}function Ai(T){let F=Pt.get(T).programs;F!==void 0&&(F.forEach(function(W){Q.releaseProgram(W)}),T.isShaderMaterial&&Q.releaseShaderCache(T))}this.renderBufferDirect=function(T,F,W,z,V,ft){F===null&&(F=wn);let vt=V.isMesh&&V.matrixWorld.determinantAffine()<0,ct=qm(T,F,W,z,V);dt.setMaterial(z,vt);let xt=W.index,bt=1;if(z.wireframe===!0){if(xt=k.getWireframeAttribute(W),xt===void 0)return;bt=2}let Ot=W.drawRange,Xt=W.attributes.position,Mt=Ot.start*bt,qt=(Ot.start+Ot.count)*bt;ft!==null&&(Mt=Math.max(Mt,ft.start*bt),qt=Math.min(qt,(ft.start+ft.count)*bt)),xt!==null?(Mt=Math.max(Mt,0),qt=Math.min(qt,xt.count)):Xt!=null&&(Mt=Math.max(Mt,0),qt=Math.min(qt,Xt.count));let Ee=qt-Mt;if(Ee<0||Ee===1/0)return;ot.setup(V,z,ct,W,xt);let fe,le=q;if(xt!==null&&(fe=w.get(xt),le=lt,le.setIndex(fe)),V.isMesh)z.wireframe===!0?(dt.setLineWidth(z.wireframeLinewidth*Tn()),le.setMode(O.LINES)):le.setMode(O.TRIANGLES);else if(V.isLine){let $e=z.linewidth;$e===void 0&&($e=1),dt.setLineWidth($e*Tn()),V.isLineSegments?le.setMode(O.LINES):V.isLineLoop?le.setMode(O.LINE_LOOP):le.setMode(O.LINE_STRIP)}else V.isPoints?le.setMode(O.POINTS):V.isSprite&&le.setMode(O.TRIANGLES);if(V.isBatchedMesh)if(ge.get("WEBGL_multi_draw"))le.renderMultiDraw(V._multiDrawStarts,V._multiDrawCounts,V._multiDrawCount);else{let $e=V._multiDrawStarts,St=V._multiDrawCounts,nn=V._multiDrawCount,jt=xt?w.get(xt).bytesPerElement:1,Qi=Pt.get(z).currentProgram.getUniforms();for(let Ze=0;Ze<nn;Ze++)Qi.setValue(O,"_gl_DrawID",Ze),le.render($e[Ze]/jt,St[Ze])}else if(V.isInstancedMesh)le.renderInstances(Mt,Ee,V.count);else if(W.isInstancedBufferGeometry){let $e=W._maxInstanceCount!==void 0?W._maxInstanceCount:1/0,St=Math.min(W.instanceCount,$e);le.renderInstances(Mt,Ee,St)}else le.render(Mt,Ee)};function Vh(T,F,W,z){I!==null&&T.isNodeMaterial&&I.setObject(z,T),Pe===!0&&Z.setState(T,W,!1),T.transparent===!0&&T.side===ye&&T.forceSinglePass===!1?(T.side=qe,T.needsUpdate=!0,_r(T,F,z),T.side=Vn,T.needsUpdate=!0,_r(T,F,z),T.side=ye):_r(T,F,z)}this.compile=function(T,F,W=null){W===null&&(W=T),I!==null&&I.renderStart(T,F,W),A=$.get(W),A.init(F),b.push(A),W.traverseVisible(function(V){V.isLight&&V.layers.test(F.layers)&&(A.pushLight(V),V.castShadow&&A.pushShadow(V))}),T!==W&&T.traverseVisible(function(V){V.isLight&&V.layers.test(F.layers)&&(A.pushLight(V),V.castShadow&&A.pushShadow(V))}),A.setupLights(),I!==null&&I.updateLights(A.state.lightsArray),un=this.localClippingEnabled,Pe=Z.init(this.clippingPlanes,un),Pe===!0&&Z.setGlobalState(this.clippingPlanes,F),I!==null&&at.render(A.state.shadowsArray,W,F);let z=new Set;return T.traverse(function(V){if(!(V.isMesh||V.isPoints||V.isLine||V.isSprite))return;let ft=V.material;if(ft)if(Array.isArray(ft))for(let vt=0;vt<ft.length;vt++){let ct=ft[vt];Vh(ct,W,F,V),z.add(ct)}else Vh(ft,W,F,V),z.add(ft)}),A=b.pop(),I!==null&&I.renderEnd(),z},this.compileAsync=function(T,F,W=null){let z=this.compile(T,F,W);return new Promise(V=>{function ft(){if(z.forEach(function(vt){let xt=Pt.get(vt).currentProgram;(xt===void 0||xt.isReady())&&z.delete(vt)}),z.size===0){V(T);return}setTimeout(ft,10)}ge.get("KHR_parallel_shader_compile")!==null?ft():setTimeout(ft,10)})};let Rc=null;function Wm(T){Rc&&Rc(T)}function Gh(){Ki.stop()}function Hh(){Ki.start()}let Ki=new up;Ki.setAnimationLoop(Wm),typeof self<"u"&&Ki.setContext(self),this.setAnimationLoop=function(T){Rc=T,it.setAnimationLoop(T),T===null?Ki.stop():Ki.start()},it.addEventListener("sessionstart",Gh),it.addEventListener("sessionend",Hh),this.render=function(T,F){if(F!==void 0&&F.isCamera!==!0){Lt("WebGLRenderer.render: camera is not an instance of THREE.Camera.");return}if(C===!0)return;I!==null&&I.renderStart(T,F);let W=it.enabled===!0&&it.isPresenting===!0,z=L!==null&&(et===null||W)&&L.begin(E,et);if(T.matrixWorldAutoUpdate===!0&&T.updateMatrixWorld(),F.parent===null&&F.matrixWorldAutoUpdate===!0&&F.updateMatrixWorld(),it.enabled===!0&&it.isPresenting===!0&&(L===null||L.isCompositing()===!1)&&(it.cameraAutoUpdate===!0&&it.updateCamera(F),F=it.getCamera()),T.isScene===!0&&T.onBeforeRender(E,T,F,et),A=$.get(T,b.length),A.init(F),A.state.textureUnits=Ft.getTextureUnits(),b.push(A),ve.multiplyMatrices(F.projectionMatrix,F.matrixWorldInverse),F.isArrayCamera?Ve.setFromArrayCamera(F):Wt.setFromProjectionMatrix(ve,Pn,F.reversedDepth),un=this.localClippingEnabled,Pe=Z.init(this.clippingPlanes,un),S=ht.get(T,_.length),S.init(),_.push(S),this.info.render.frame++,it.enabled===!0&&it.isPresenting===!0){let vt=E.xr.getDepthSensingMesh();vt!==null&&Cc(vt,F,-1/0,E.sortObjects)}Cc(T,F,0,E.sortObjects),S.finish(),I!==null&&I.updateLights(A.state.lightsArray),E.sortObjects===!0&&S.sort(Ut,Se),An=it.enabled===!1||it.isPresenting===!1||it.hasDepthSensing()===!1,An&&D.addToRenderList(S,T),this.info.autoReset===!0&&this.info.reset(),Pe===!0&&Z.beginShadows();let V=A.state.shadowsArray;if(at.render(V,T,F),Pe===!0&&Z.endShadows(),(z&&L.hasRenderPass())===!1){let vt=S.opaque,ct=S.transmissive;if(A.setupLights(),F.isArrayCamera){let xt=F.cameras;if(ct.length>0)for(let bt=0,Ot=xt.length;bt<Ot;bt++){let Xt=xt[bt];Xh(vt,ct,T,Xt)}An&&D.render(T);for(let bt=0,Ot=xt.length;bt<Ot;bt++){let Xt=xt[bt];Wh(S,T,Xt,Xt.viewport)}}else ct.length>0&&Xh(vt,ct,T,F),An&&D.render(T),Wh(S,T,F)}et!==null&&G===0&&(Ft.updateMultisampleRenderTarget(et),Ft.updateRenderTargetMipmap(et)),z&&L.end(E),T.isScene===!0&&T.onAfterRender(E,T,F),ot.resetDefaultState(),X=-1,j=null,b.pop(),b.length>0?(A=b[b.length-1],Ft.setTextureUnits(A.state.textureUnits),Pe===!0&&Z.setGlobalState(E.clippingPlanes,A.state.camera)):A=null,_.pop(),_.length>0?S=_[_.length-1]:S=null,I!==null&&I.renderEnd()};function Cc(T,F,W,z){if(T.visible===!1)return;if(T.layers.test(F.layers)){if(T.isGroup)W=T.renderOrder;else if(T.isLOD)T.autoUpdate===!0&&T.update(F);else if(T.isLight)A.pushLight(T),T.castShadow&&A.pushShadow(T);else if(T.isSprite){let vt=F.isArrayCamera?Ve:Wt;if(!T.frustumCulled||T.intersectsFrustum(vt)){z&&Fe.setFromMatrixPosition(T.matrixWorld).applyMatrix4(ve);let ct=nt.update(T),xt=T.material;xt.visible&&S.push(T,ct,xt,W,Fe.z,null,F)}}else if(T.isMesh||T.isLine||T.isPoints){let vt=F.isArrayCamera?Ve:Wt;if(!T.frustumCulled||T.intersectsFrustum(vt)){let ct=nt.update(T),xt=T.material;if(z&&(T.boundingSphere!==void 0?(T.boundingSphere===null&&T.computeBoundingSphere(),Fe.copy(T.boundingSphere.center)):(ct.boundingSphere===null&&ct.computeBoundingSphere(),Fe.copy(ct.boundingSphere.center)),Fe.applyMatrix4(T.matrixWorld).applyMatrix4(ve)),Array.isArray(xt)){let bt=ct.groups;for(let Ot=0,Xt=bt.length;Ot<Xt;Ot++){let Mt=bt[Ot],qt=xt[Mt.materialIndex];qt&&qt.visible&&S.push(T,ct,qt,W,Fe.z,Mt,F)}}else xt.visible&&S.push(T,ct,xt,W,Fe.z,null,F)}}}let ft=T.children;for(let vt=0,ct=ft.length;vt<ct;vt++)Cc(ft[vt],F,W,z)}function Wh(T,F,W,z){let{opaque:V,transmissive:ft,transparent:vt}=T;A.setupLightsView(W),Pe===!0&&Z.setGlobalState(E.clippingPlanes,W),z&&dt.viewport(tt.copy(z)),V.length>0&&Mo(V,F,W),ft.length>0&&Mo(ft,F,W),vt.length>0&&Mo(vt,F,W),dt.buffers.depth.setTest(!0),dt.buffers.depth.setMask(!0),dt.buffers.color.setMask(!0),dt.setPolygonOffset(!1)}function Xh(T,F,W,z){if((W.isScene===!0?W.overrideMaterial:null)!==null)return;if(A.state.transmissionRenderTarget[z.id]===void 0){let Mt=ge.has("EXT_color_buffer_half_float")||ge.has("EXT_color_buffer_float");A.state.transmissionRenderTarget[z.id]=new on(1,1,{generateMipmaps:!0,type:Mt?Wn:ln,minFilter:vi,samples:Math.max(4,xe.samples),stencilBuffer:r,resolveDepthBuffer:!1,resolveStencilBuffer:!1,storeMultisampledDepthBuffer:!1,storeMultisampledStencilBuffer:!1,colorSpace:Yt.workingColorSpace})}let ft=A.state.transmissionRenderTarget[z.id],vt=z.viewport||tt;ft.setSize(vt.z*E.transmissionResolutionScale,vt.w*E.transmissionResolutionScale);let ct=E.getRenderTarget(),xt=E.getActiveCubeFace(),bt=E.getActiveMipmapLevel();E.setRenderTarget(ft),E.getClearColor(J),ut=E.getClearAlpha(),ut<1&&E.setClearColor(16777215,.5),E.clear(),An&&D.render(W);let Ot=E.toneMapping;E.toneMapping=Qn;let Xt=z.viewport;if(z.viewport!==void 0&&(z.viewport=void 0),A.setupLightsView(z),Pe===!0&&Z.setGlobalState(E.clippingPlanes,z),Mo(T,W,z),Ft.updateMultisampleRenderTarget(ft),Ft.updateRenderTargetMipmap(ft),ge.has("WEBGL_multisampled_render_to_texture")===!1){let Mt=!1;for(let qt=0,Ee=F.length;qt<Ee;qt++){let fe=F[qt],{object:le,geometry:$e,material:St,group:nn}=fe;if(St.side===ye&&le.layers.test(z.layers)){let jt=St.side;St.side=qe,St.needsUpdate=!0,qh(le,W,z,$e,St,nn),St.side=jt,St.needsUpdate=!0,Mt=!0}}Mt===!0&&(Ft.updateMultisampleRenderTarget(ft),Ft.updateRenderTargetMipmap(ft))}E.setRenderTarget(ct,xt,bt),E.setClearColor(J,ut),Xt!==void 0&&(z.viewport=Xt),E.toneMapping=Ot}function Mo(T,F,W){let z=F.isScene===!0?F.overrideMaterial:null;for(let V=0,ft=T.length;V<ft;V++){let vt=T[V],{object:ct,geometry:xt,group:bt}=vt,Ot=vt.material;Ot.allowOverride===!0&&z!==null&&(Ot=z),ct.layers.test(W.layers)&&qh(ct,F,W,xt,Ot,bt)}}function qh(T,F,W,z,V,ft){I!==null&&V.isNodeMaterial&&I.setObject(T,V),T.onBeforeRender(E,F,W,z,V,ft),T.modelViewMatrix.multiplyMatrices(W.matrixWorldInverse,T.matrixWorld),T.normalMatrix.getNormalMatrix(T.modelViewMatrix),V.onBeforeRender(E,F,W,z,T,ft),V.transparent===!0&&V.side===ye&&V.forceSinglePass===!1?(V.side=qe,V.needsUpdate=!0,E.renderBufferDirect(W,F,z,V,T,ft),V.side=Vn,V.needsUpdate=!0,E.renderBufferDirect(W,F,z,V,T,ft),V.side=ye):E.renderBufferDirect(W,F,z,V,T,ft),T.onAfterRender(E,F,W,z,V,ft)}function Yh(T){let F=0;for(let W of T)W.texture!==null&&F++;return F}function _r(T,F,W){F.isScene!==!0&&(F=wn);let z=Pt.get(T),V=A.state.lights,ft=A.state.shadowsArray,vt=V.state.version,ct=Q.getParameters(T,V.state,ft,F,W,A.state.lightProbeGridArray),xt=Q.getProgramCacheKey(ct),bt=z.programs;z.environment=T.isMeshStandardMaterial||T.isMeshLambertMaterial||T.isMeshPhongMaterial?F.environment:null,z.fog=F.fog;let Ot=T.isMeshStandardMaterial||T.isMeshLambertMaterial&&!T.envMap||T.isMeshPhongMaterial&&!T.envMap;z.envMap=R.get(T.envMap||z.environment,Ot),z.envMapRotation=z.environment!==null&&T.envMap===null?F.environmentRotation:T.envMapRotation,bt===void 0&&(T.addEventListener("dispose",se),bt=new Map,z.programs=bt,z.programVariants=new Map);let Xt=bt.get(xt);if(Xt!==void 0){if(z.currentProgram===Xt&&z.lightsStateVersion===vt)return Zh(T,ct),Xt}else ct.uniforms=Q.getUniforms(T),I!==null&&T.isNodeMaterial&&I.build(T,W,ct),T.onBeforeCompile(ct,E),Xt=Q.acquireProgram(ct,xt),bt.set(xt,Xt),z.uniforms=ct.uniforms;let Mt=z.uniforms;return(!T.isShaderMaterial&&!T.isRawShaderMaterial||T.clipping===!0)&&(Mt.clippingPlanes=Z.uniform),Zh(T,ct),z.needsLights=$m(T),z.lightsStateVersion=vt,z.needsLights&&(Mt.ambientLightColor.value=V.state.ambient,Mt.lightProbe.value=V.state.probe,Mt.sunLights.value=V.state.sun,Mt.sunLightShadows.value=V.state.sunShadow,Mt.directionalLights.value=V.state.directional,Mt.directionalLightShadows.value=V.state.directionalShadow,Mt.spotLights.value=V.state.spot,Mt.spotLightShadows.value=V.state.spotShadow,Mt.rectAreaLights.value=V.state.rectArea,Mt.ltc_1.value=V.state.rectAreaLTC1,Mt.ltc_2.value=V.state.rectAreaLTC2,Mt.pointLights.value=V.state.point,Mt.pointLightShadows.value=V.state.pointShadow,Mt.hemisphereLights.value=V.state.hemi,Mt.sunShadowMatrix.value=V.state.sunShadowMatrix,Mt.sunShadowCascade.value=V.state.sunShadowCascade,Mt.directionalShadowMatrix.value=V.state.directionalShadowMatrix,Mt.spotLightMatrix.value=V.state.spotLightMatrix,Mt.spotLightMap.value=V.state.spotLightMap,Mt.pointShadowMatrix.value=V.state.pointShadowMatrix),z.numLightProbeGrids=Yh(A.state.lightProbeGridArray),z.currentProgram=Xt,z.uniformsList=null,Xt}function Xm(T,F,W,z,V){let ft=Pt.get(T),vt=ft.currentProgram.id+","+z+","+V,ct=ft.programVariants.get(vt);return ct===void 0?(ct=_r(T,F,W),ft.programVariants.set(vt,ct)):(ft.currentProgram=ct,ft.uniformsList=null,ft.outputColorSpace=z,ft.toneMapping=V),ct}function $h(T){if(T.uniformsList===null){let F=T.currentProgram.getUniforms();T.uniformsList=js.seqWithValue(F.seq,T.uniforms)}return T.uniformsList}function Zh(T,F){let W=Pt.get(T);W.outputColorSpace=F.outputColorSpace,W.batching=F.batching,W.batchingColor=F.batchingColor,W.instancing=F.instancing,W.instancingColor=F.instancingColor,W.instancingMorph=F.instancingMorph,W.skinning=F.skinning,W.morphTargets=F.morphTargets,W.morphNormals=F.morphNormals,W.morphColors=F.morphColors,W.morphTargetsCount=F.morphTargetsCount,W.numClippingPlanes=F.numClippingPlanes,W.numIntersection=F.numClipIntersection,W.vertexAlphas=F.vertexAlphas,W.vertexTangents=F.vertexTangents,W.toneMapping=F.toneMapping}function qm(T,F,W,z,V){F.isScene!==!0&&(F=wn),Ft.resetTextureUnits();let ft=F.fog,vt=z.isMeshStandardMaterial||z.isMeshLambertMaterial||z.isMeshPhongMaterial?F.environment:null,ct=et===null?E.outputColorSpace:et.isXRRenderTarget===!0?et.texture.colorSpace:Yt.workingColorSpace,xt=z.isMeshStandardMaterial||z.isMeshLambertMaterial&&!z.envMap||z.isMeshPhongMaterial&&!z.envMap,bt=R.get(z.envMap||vt,xt),Ot=z.vertexColors===!0&&!!W.attributes.color&&W.attributes.color.itemSize===4,Xt=!!W.attributes.tangent&&(!!z.normalMap||z.anisotropy>0),Mt=!!W.morphAttributes.position,qt=!!W.morphAttributes.normal,Ee=!!W.morphAttributes.color,fe=Qn;z.toneMapped&&(et===null||et.isXRRenderTarget===!0)&&(fe=E.toneMapping);let le=W.morphAttributes.position||W.morphAttributes.normal||W.morphAttributes.color,$e=le!==void 0?le.length:0,St=Pt.get(z),nn=A.state.lights;if(Pe===!0&&(un===!0||T!==j)){let Me=T===j&&z.id===X;Z.setState(z,T,Me)}let jt=!1,Qi=!1;z.version===St.__version?St.needsLights&&St.lightsStateVersion!==nn.state.version||V.isBatchedMesh&&St.batching===!1||!V.isBatchedMesh&&St.batching===!0||V.isBatchedMesh&&St.batchingColor===!0&&V._colorsTexture===null||V.isBatchedMesh&&St.batchingColor===!1&&V._colorsTexture!==null||V.isInstancedMesh&&St.instancing===!1||!V.isInstancedMesh&&St.instancing===!0||V.isSkinnedMesh&&St.skinning===!1||!V.isSkinnedMesh&&St.skinning===!0||V.isInstancedMesh&&St.instancingColor===!0&&V.instanceColor===null||V.isInstancedMesh&&St.instancingColor===!1&&V.instanceColor!==null||V.isInstancedMesh&&St.instancingMorph===!0&&V.morphTexture===null||V.isInstancedMesh&&St.instancingMorph===!1&&V.morphTexture!==null||St.envMap!==bt||z.fog===!0&&St.fog!==ft||St.numClippingPlanes!==void 0&&(St.numClippingPlanes!==Z.numPlanes||St.numIntersection!==Z.numIntersection)||St.vertexAlphas!==Ot||St.vertexTangents!==Xt||St.morphTargets!==Mt||St.morphNormals!==qt||St.morphColors!==Ee||St.morphTargetsCount!==$e||St.numLightProbeGrids!==Yh(A.state.lightProbeGridArray)?jt=!0:(St.outputColorSpace!==ct||St.toneMapping!==fe)&&(Qi=!0):(jt=!0,St.__version=z.version);let Ze=St.currentProgram;(jt===!0||Qi===!0)&&(Ze=Qi===!0?Xm(z,F,V,ct,fe):_r(z,F,V),I&&z.isNodeMaterial&&I.onUpdateProgram(z,Ze,St));let So=!1,Ti=!1,ji=!1,Qt=Ze.getUniforms(),Ge=St.uniforms;if(dt.useProgram(Ze.program)&&(So=!0,Ti=!0,ji=!0),z.id!==X&&(X=z.id,Ti=!0),So||j!==T){dt.buffers.depth.getReversed()&&T.reversedDepth!==!0&&(T._reversedDepth=!0,T.updateProjectionMatrix()),Qt.setValue(O,"projectionMatrix",T.projectionMatrix),Qt.setValue(O,"viewMatrix",T.matrixWorldInverse);let Be=Qt.map.cameraPosition;Be!==void 0&&Be.setValue(O,Yn.setFromMatrixPosition(T.matrixWorld)),xe.logarithmicDepthBuffer&&Qt.setValue(O,"logDepthBufFC",2/(Math.log(T.far+1)/Math.LN2)),(z.isMeshPhongMaterial||z.isMeshToonMaterial||z.isMeshLambertMaterial||z.isMeshBasicMaterial||z.isMeshStandardMaterial||z.isShaderMaterial)&&Qt.setValue(O,"isOrthographic",T.isOrthographicCamera===!0),j!==T&&(j=T,Ti=!0,ji=!0)}if(St.needsLights&&(nn.state.sunShadowMap.length>0&&Qt.setValue(O,"sunShadowMap",nn.state.sunShadowMap,Ft),nn.state.directionalShadowMap.length>0&&Qt.setValue(O,"directionalShadowMap",nn.state.directionalShadowMap,Ft),nn.state.spotShadowMap.length>0&&Qt.setValue(O,"spotShadowMap",nn.state.spotShadowMap,Ft),nn.state.pointShadowMap.length>0&&Qt.setValue(O,"pointShadowMap",nn.state.pointShadowMap,Ft)),V.isSkinnedMesh){Qt.setOptional(O,V,"bindMatrix"),Qt.setOptional(O,V,"bindMatrixInverse");let Me=V.skeleton;Me&&(Me.boneTexture===null&&Me.computeBoneTexture(),Qt.setValue(O,"boneTexture",Me.boneTexture,Ft))}V.isBatchedMesh&&(Qt.setOptional(O,V,"batchingTexture"),Qt.setValue(O,"batchingTexture",V._matricesTexture,Ft),Qt.setOptional(O,V,"batchingIdTexture"),Qt.setValue(O,"batchingIdTexture",V._indirectTexture,Ft),Qt.setOptional(O,V,"batchingColorTexture"),V._colorsTexture!==null&&Qt.setValue(O,"batchingColorTexture",V._colorsTexture,Ft));let Nn=W.morphAttributes;if((Nn.position!==void 0||Nn.normal!==void 0||Nn.color!==void 0)&&K.update(V,W,Ze),(Ti||St.receiveShadow!==V.receiveShadow)&&(St.receiveShadow=V.receiveShadow,Qt.setValue(O,"receiveShadow",V.receiveShadow)),(z.isMeshStandardMaterial||z.isMeshLambertMaterial||z.isMeshPhongMaterial)&&z.envMap===null&&F.environment!==null&&(Ge.envMapIntensity.value=F.environmentIntensity),Ge.dfgLUT!==void 0&&(Ge.dfgLUT.value=Hv()),Ti){if(Qt.setValue(O,"toneMappingExposure",E.toneMappingExposure),St.needsLights&&Ym(Ge,ji),ft&&z.fog===!0&&rt.refreshFogUniforms(Ge,ft),rt.refreshMaterialUniforms(Ge,z,pt,Tt,A.state.transmissionRenderTarget[T.id]),St.needsLights&&St.numLightProbeGrids>0){let Me=v,Be=0;for(let ri of A.state.lightProbeGridArray)ri.texture!==null&&(Me.textures[Be]=ri.texture,Me.min[Be]=ri.boundingBox.min,Me.max[Be]=ri.boundingBox.max,Me.resolution[Be]=ri.resolution,Be++);for(let ri in Me)Me[ri].length=Be;Ge.probesSH.value=Me.textures,Ge.probesMin.value=Me.min,Ge.probesMax.value=Me.max,Ge.probesResolution.value=Me.resolution}js.upload(O,$h(St),Ge,Ft)}if(z.isShaderMaterial&&z.uniformsNeedUpdate===!0&&(js.upload(O,$h(St),Ge,Ft),z.uniformsNeedUpdate=!1),z.isSpriteMaterial&&Qt.setValue(O,"center",V.center),Qt.setValue(O,"modelViewMatrix",V.modelViewMatrix),Qt.setValue(O,"normalMatrix",V.normalMatrix),Qt.setValue(O,"modelMatrix",V.matrixWorld),z.uniformsGroups!==void 0){let Me=z.uniformsGroups;for(let Be=0,ri=Me.length;Be<ri;Be++){let Kh=Me[Be];wt.update(Kh,Ze),wt.bind(Kh,Ze)}}return Ze}function Ym(T,F){T.ambientLightColor.needsUpdate=F,T.lightProbe.needsUpdate=F,T.sunLights.needsUpdate=F,T.sunLightShadows.needsUpdate=F,T.directionalLights.needsUpdate=F,T.directionalLightShadows.needsUpdate=F,T.pointLights.needsUpdate=F,T.pointLightShadows.needsUpdate=F,T.spotLights.needsUpdate=F,T.spotLightShadows.needsUpdate=F,T.rectAreaLights.needsUpdate=F,T.hemisphereLights.needsUpdate=F}function $m(T){return T.isMeshLambertMaterial||T.isMeshToonMaterial||T.isMeshPhongMaterial||T.isMeshStandardMaterial||T.isShadowMaterial||T.isShaderMaterial&&T.lights===!0}this.getActiveCubeFace=function(){return H},this.getActiveMipmapLevel=function(){return G},this.getRenderTarget=function(){return et},this.setRenderTargetTextures=function(T,F,W){let z=Pt.get(T);z.__autoAllocateDepthBuffer=T.resolveDepthBuffer===!1,z.__autoAllocateDepthBuffer===!1&&(z.__useRenderToTexture=!1),Pt.get(T.texture).__webglTexture=F,Pt.get(T.depthTexture).__webglTexture=z.__autoAllocateDepthBuffer?void 0:W,z.__hasExternalTextures=!0},this.setRenderTargetFramebuffer=function(T,F){let W=Pt.get(T);W.__webglFramebuffer=F,W.__useDefaultFramebuffer=F===void 0},this.setRenderTarget=function(T,F=0,W=0){et=T,H=F,G=W;let z=null,V=!1,ft=!1;if(T){let ct=Pt.get(T);if(ct.__useDefaultFramebuffer!==void 0){dt.bindFramebuffer(O.FRAMEBUFFER,ct.__webglFramebuffer),tt.copy(T.viewport),yt.copy(T.scissor),Nt=T.scissorTest,dt.viewport(tt),dt.scissor(yt),dt.setScissorTest(Nt),X=-1;return}else if(ct.__webglFramebuffer===void 0)Ft.setupRenderTarget(T);else if(ct.__hasExternalTextures)Ft.rebindTextures(T,Pt.get(T.texture).__webglTexture,Pt.get(T.depthTexture).__webglTexture);else if(T.depthBuffer){let Ot=T.depthTexture;if(ct.__boundDepthTexture!==Ot){if(Ot!==null&&Pt.has(Ot)&&(T.width!==Ot.image.width||T.height!==Ot.image.height))throw new Error("THREE.WebGLRenderer: Attached DepthTexture is initialized to the incorrect size.");Ft.setupDepthRenderbuffer(T)}}let xt=T.texture;(xt.isData3DTexture||xt.isDataArrayTexture||xt.isCompressedArrayTexture)&&(ft=!0);let bt=Pt.get(T).__webglFramebuffer;T.isWebGLCubeRenderTarget?(Array.isArray(bt[F])?z=bt[F][W]:z=bt[F],V=!0):T.samples>0&&Ft.useMultisampledRTT(T)===!1?z=Pt.get(T).__webglMultisampledFramebuffer:Array.isArray(bt)?z=bt[W]:z=bt,tt.copy(T.viewport),yt.copy(T.scissor),Nt=T.scissorTest}else tt.copy(Ct).multiplyScalar(pt).floor(),yt.copy(Kt).multiplyScalar(pt).floor(),Nt=ae;if(W!==0&&(z=U),dt.bindFramebuffer(O.FRAMEBUFFER,z)&&dt.drawBuffers(T,z),dt.viewport(tt),dt.scissor(yt),dt.setScissorTest(Nt),V){let ct=Pt.get(T.texture);O.framebufferTexture2D(O.FRAMEBUFFER,O.COLOR_ATTACHMENT0,O.TEXTURE_CUBE_MAP_POSITIVE_X+F,ct.__webglTexture,W)}else if(ft){let ct=F;for(let xt=0;xt<T.textures.length;xt++){let bt=Pt.get(T.textures[xt]);O.framebufferTextureLayer(O.FRAMEBUFFER,O.COLOR_ATTACHMENT0+xt,bt.__webglTexture,W,ct)}}else if(T!==null&&W!==0){let ct=Pt.get(T.texture);O.framebufferTexture2D(O.FRAMEBUFFER,O.COLOR_ATTACHMENT0,O.TEXTURE_2D,ct.__webglTexture,W)}X=-1};function Jh(T){let F=Pt.get(T);return(F.__readFormat!==T.format||F.__readType!==T.type)&&(F.__readFormat=T.format,F.__readType=T.type,F.__formatReadable=xe.textureFormatReadable(T.format),F.__typeReadable=xe.textureTypeReadable(T.type)),F}this.readRenderTargetPixels=function(T,F,W,z,V,ft,vt,ct=0){if(!(T&&T.isWebGLRenderTarget)){Lt("WebGLRenderer.readRenderTargetPixels: renderTarget is not THREE.WebGLRenderTarget.");return}let xt=Pt.get(T).__webglFramebuffer;if(T.isWebGLCubeRenderTarget&&vt!==void 0&&(xt=xt[vt],Array.isArray(xt)&&(xt=xt[0])),xt){dt.bindFramebuffer(O.FRAMEBUFFER,xt);try{let bt=T.textures[ct],Ot=bt.format,Xt=bt.type;T.textures.length>1&&O.readBuffer(O.COLOR_ATTACHMENT0+ct);let Mt=Jh(bt);if(Mt.__formatReadable===!1){Lt("WebGLRenderer.readRenderTargetPixels: renderTarget is not in RGBA or implementation defined format.");return}if(Mt.__typeReadable===!1){Lt("WebGLRenderer.readRenderTargetPixels: renderTarget is not in UnsignedByteType or implementation defined type.");return}F>=0&&F<=T.width-z&&W>=0&&W<=T.height-V&&O.readPixels(F,W,z,V,st.convert(Ot),st.convert(Xt),ft)}finally{let bt=et!==null?Pt.get(et).__webglFramebuffer:null;dt.bindFramebuffer(O.FRAMEBUFFER,bt)}}},this.readRenderTargetPixelsAsync=async function(T,F,W,z,V,ft,vt,ct=0){if(!(T&&T.isWebGLRenderTarget))throw new Error("THREE.WebGLRenderer.readRenderTargetPixels: renderTarget is not THREE.WebGLRenderTarget.");let xt=Pt.get(T).__webglFramebuffer;if(T.isWebGLCubeRenderTarget&&vt!==void 0&&(xt=xt[vt],Array.isArray(xt)&&(xt=xt[0])),xt)if(F>=0&&F<=T.width-z&&W>=0&&W<=T.height-V){dt.bindFramebuffer(O.FRAMEBUFFER,xt);let bt=T.textures[ct],Ot=bt.format,Xt=bt.type;T.textures.length>1&&O.readBuffer(O.COLOR_ATTACHMENT0+ct);let Mt=Jh(bt);if(Mt.__formatReadable===!1)throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: renderTarget is not in RGBA or implementation defined format.");if(Mt.__typeReadable===!1)throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: renderTarget is not in UnsignedByteType or implementation defined type.");let qt=O.createBuffer();O.bindBuffer(O.PIXEL_PACK_BUFFER,qt),O.bufferData(O.PIXEL_PACK_BUFFER,ft.byteLength,O.STREAM_READ),O.readPixels(F,W,z,V,st.convert(Ot),st.convert(Xt),0),O.bindBuffer(O.PIXEL_PACK_BUFFER,null);let Ee=et!==null?Pt.get(et).__webglFramebuffer:null;dt.bindFramebuffer(O.FRAMEBUFFER,Ee);let fe=O.fenceSync(O.SYNC_GPU_COMMANDS_COMPLETE,0);return O.flush(),await Fd(O,fe,4),O.bindBuffer(O.PIXEL_PACK_BUFFER,qt),O.getBufferSubData(O.PIXEL_PACK_BUFFER,0,ft),O.bindBuffer(O.PIXEL_PACK_BUFFER,null),O.deleteBuffer(qt),O.deleteSync(fe),ft}else throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: requested read bounds are out of range.")},this.copyFramebufferToTexture=function(T,F=null,W=0){let z=Math.pow(2,-W),V=Math.floor(T.image.width*z),ft=Math.floor(T.image.height*z),vt=F!==null?F.x:0,ct=F!==null?F.y:0;Ft.setTexture2D(T,0),O.copyTexSubImage2D(O.TEXTURE_2D,W,0,0,vt,ct,V,ft),dt.unbindTexture()},this.copyTextureToTexture=function(T,F,W=null,z=null,V=0,ft=0){let vt,ct,xt,bt,Ot,Xt,Mt,qt,Ee,fe=T.isCompressedTexture?T.mipmaps[ft]:T.image;if(W!==null)vt=W.max.x-W.min.x,ct=W.max.y-W.min.y,xt=W.isBox3?W.max.z-W.min.z:1,bt=W.min.x,Ot=W.min.y,Xt=W.isBox3?W.min.z:0;else{let Qt=Math.pow(2,-V);vt=Math.floor(fe.width*Qt),ct=Math.floor(fe.height*Qt),T.isDataArrayTexture?xt=fe.depth:T.isData3DTexture?xt=Math.floor(fe.depth*Qt):xt=1,bt=0,Ot=0,Xt=0}z!==null?(Mt=z.x,qt=z.y,Ee=z.z):(Mt=0,qt=0,Ee=0);let le=st.convert(F.format),$e=st.convert(F.type),St;F.isData3DTexture?(Ft.setTexture3D(F,0),St=O.TEXTURE_3D):F.isDataArrayTexture||F.isCompressedArrayTexture?(Ft.setTexture2DArray(F,0),St=O.TEXTURE_2D_ARRAY):(Ft.setTexture2D(F,0),St=O.TEXTURE_2D),dt.activeTexture(O.TEXTURE0),dt.pixelStorei(O.UNPACK_FLIP_Y_WEBGL,F.flipY),dt.pixelStorei(O.UNPACK_PREMULTIPLY_ALPHA_WEBGL,F.premultiplyAlpha),dt.pixelStorei(O.UNPACK_ALIGNMENT,F.unpackAlignment);let nn=dt.getParameter(O.UNPACK_ROW_LENGTH),jt=dt.getParameter(O.UNPACK_IMAGE_HEIGHT),Qi=dt.getParameter(O.UNPACK_SKIP_PIXELS),Ze=dt.getParameter(O.UNPACK_SKIP_ROWS),So=dt.getParameter(O.UNPACK_SKIP_IMAGES);dt.pixelStorei(O.UNPACK_ROW_LENGTH,fe.width),dt.pixelStorei(O.UNPACK_IMAGE_HEIGHT,fe.height),dt.pixelStorei(O.UNPACK_SKIP_PIXELS,bt),dt.pixelStorei(O.UNPACK_SKIP_ROWS,Ot),dt.pixelStorei(O.UNPACK_SKIP_IMAGES,Xt);let Ti=T.isDataArrayTexture||T.isData3DTexture,ji=F.isDataArrayTexture||F.isData3DTexture;if(T.isDepthTexture){let Qt=Pt.get(T),Ge=Pt.get(F),Nn=Pt.get(Qt.__renderTarget),Me=Pt.get(Ge.__renderTarget);dt.bindFramebuffer(O.READ_FRAMEBUFFER,Nn.__webglFramebuffer),dt.bindFramebuffer(O.DRAW_FRAMEBUFFER,Me.__webglFramebuffer);for(let Be=0;Be<xt;Be++)Ti&&(O.framebufferTextureLayer(O.READ_FRAMEBUFFER,O.COLOR_ATTACHMENT0,Pt.get(T).__webglTexture,V,Xt+Be),O.framebufferTextureLayer(O.DRAW_FRAMEBUFFER,O.COLOR_ATTACHMENT0,Pt.get(F).__webglTexture,ft,Ee+Be)),O.blitFramebuffer(bt,Ot,bt+vt,Ot+ct,Mt,qt,Mt+vt,qt+ct,O.DEPTH_BUFFER_BIT,O.NEAREST);dt.bindFramebuffer(O.READ_FRAMEBUFFER,null),dt.bindFramebuffer(O.DRAW_FRAMEBUFFER,null)}else if(V!==0||T.isRenderTargetTexture||Pt.has(T)){let Qt=Pt.get(T),Ge=Pt.get(F);dt.bindFramebuffer(O.READ_FRAMEBUFFER,P),dt.bindFramebuffer(O.DRAW_FRAMEBUFFER,B);for(let Nn=0;Nn<xt;Nn++)Ti?O.framebufferTextureLayer(O.READ_FRAMEBUFFER,O.COLOR_ATTACHMENT0,Qt.__webglTexture,V,Xt+Nn):O.framebufferTexture2D(O.READ_FRAMEBUFFER,O.COLOR_ATTACHMENT0,O.TEXTURE_2D,Qt.__webglTexture,V),ji?O.framebufferTextureLayer(O.DRAW_FRAMEBUFFER,O.COLOR_ATTACHMENT0,Ge.__webglTexture,ft,Ee+Nn):O.framebufferTexture2D(O.DRAW_FRAMEBUFFER,O.COLOR_ATTACHMENT0,O.TEXTURE_2D,Ge.__webglTexture,ft),V!==0?O.blitFramebuffer(bt,Ot,bt+vt,Ot+ct,Mt,qt,Mt+vt,qt+ct,O.COLOR_BUFFER_BIT,O.NEAREST):ji?O.copyTexSubImage3D(St,ft,Mt,qt,Ee+Nn,bt,Ot,vt,ct):O.copyTexSubImage2D(St,ft,Mt,qt,bt,Ot,vt,ct);dt.bindFramebuffer(O.READ_FRAMEBUFFER,null),dt.bindFramebuffer(O.DRAW_FRAMEBUFFER,null)}else ji?T.isDataTexture||T.isData3DTexture?O.texSubImage3D(St,ft,Mt,qt,Ee,vt,ct,xt,le,$e,fe.data):F.isCompressedArrayTexture?O.compressedTexSubImage3D(St,ft,Mt,qt,Ee,vt,ct,xt,le,fe.data):O.texSubImage3D(St,ft,Mt,qt,Ee,vt,ct,xt,le,$e,fe):T.isDataTexture?O.texSubImage2D(O.TEXTURE_2D,ft,Mt,qt,vt,ct,le,$e,fe.data):T.isCompressedTexture?O.compressedTexSubImage2D(O.TEXTURE_2D,ft,Mt,qt,fe.width,fe.height,le,fe.data):O.texSubImage2D(O.TEXTURE_2D,ft,Mt,qt,vt,ct,le,$e,fe);dt.pixelStorei(O.UNPACK_ROW_LENGTH,nn),dt.pixelStorei(O.UNPACK_IMAGE_HEIGHT,jt),dt.pixelStorei(O.UNPACK_SKIP_PIXELS,Qi),dt.pixelStorei(O.UNPACK_SKIP_ROWS,Ze),dt.pixelStorei(O.UNPACK_SKIP_IMAGES,So),ft===0&&F.generateMipmaps===!0&&F.mipmapsAutoUpdate===!0&&O.generateMipmap(St),dt.unbindTexture()},this.initRenderTarget=function(T){Pt.get(T).__webglFramebuffer===void 0&&Ft.setupRenderTarget(T)},this.initTexture=function(T){T.isCubeTexture?Ft.setTextureCube(T,0):T.isData3DTexture?Ft.setTexture3D(T,0):T.isDataArrayTexture||T.isCompressedArrayTexture?Ft.setTexture2DArray(T,0):Ft.setTexture2D(T,0),dt.unbindTexture()},this.resetState=function(){H=0,G=0,et=null,dt.reset(),ot.reset()},typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("observe",{detail:this}))}get coordinateSystem(){return Pn}get outputColorSpace(){return this._outputColorSpace}set outputColorSpace(t){this._outputColorSpace=t;let e=this.getContext();e.drawingBufferColorSpace=Yt._getDrawingBufferColorSpace(t),e.unpackColorSpace=Yt._getUnpackColorSpace()}};var lo={1:["front",-90,0],2:["back",90,0],3:["left",180,0],4:["right",0,0],5:["top",-90,90],6:["bottom",-90,-90],7:["corner",-50,32]},Wv=320,Nl=class{constructor(t,e,n,s,r,o,l){this.z=t;this.centre=n;this.radius=s;this.changed=r;this.vertices=o;this.beyond=l;let a=e??(Math.abs(t[2])>.9?[1,0,0]:Ci(t));this.x=yr(ce(a,t,-It(a,t))),this.y=Le(t,this.x),this.aim={target:n,turn:-50,rise:32,half:s},this.apply()}z;centre;radius;changed;vertices;beyond;camera=new Gi;aim;aspect=1;flight=0;moved=!1;x;y;fitted(t,e,n=this.aspect){let{up:s,right:r}=this.frame({target:this.centre,turn:t,rise:e,half:1}),o=this.vertices();if(!o.length)return{target:this.centre,turn:t,rise:e,half:this.radius};let[l,a,c,u]=[1/0,1/0,-1/0,-1/0];for(let g=0;g<o.length;g+=3){let y=o[g]*r[0]+o[g+1]*r[1]+o[g+2]*r[2],p=o[g]*s[0]+o[g+1]*s[1]+o[g+2]*s[2];y<l&&(l=y),y>c&&(c=y),p<a&&(a=p),p>u&&(u=p)}let h=(g,y)=>Ei(g,y-It(this.centre,g)),f=ce(ce(this.centre,h(r,(l+c)/2)),h(s,(a+u)/2)),d=.53*Math.max(u-a,(c-l)/n,.001*this.radius);return{target:f,turn:t,rise:e,half:d}}holding(t,e,n){let{up:s,right:r}=this.frame({target:this.centre,turn:t,rise:e,half:1}),[[o,l],[a,c]]=[r,s].map(d=>{let g=({radius:p,axis:m})=>p*(m?Math.sqrt(Math.max(0,1-It(m,d)**2)):1),y=n.flatMap(p=>[-1,1].map(m=>It(p.centre,d)+m*g(p)));return[Math.min(...y),Math.max(...y)]}),u=n[0].centre,h=(d,g)=>Ei(d,g-It(u,d));return{target:ce(ce(u,h(r,(o+l)/2)),h(s,(a+c)/2)),turn:t,rise:e,half:.54*Math.max(c-a,(l-o)/this.aspect,.001*this.radius)}}resize(t){this.aspect=t,this.moved||(this.aim=this.fitted(this.aim.turn,this.aim.rise)),this.apply()}frame(t=this.aim){let[e,n]=[t.turn*Ne,t.rise*Ne],s=He(this.x,Math.cos(e),this.y,Math.sin(e)),r=He(s,Math.cos(n),this.z,Math.sin(n)),o=He(s,-Math.sin(n),this.z,Math.cos(n));return{back:r,up:o,right:Le(o,r)}}apply(){this.point(this.camera,this.aim,this.aspect),this.changed()}point(t,e,n){let{back:s,up:r,right:o}=this.frame(e),{target:l,half:a}=e,c=12*this.radius+2*this.beyond,u=2*c,h=ce(l,s,u);t.position.set(...h),t.quaternion.setFromRotationMatrix(new zt().makeBasis(new N(...o),new N(...r),new N(...s))),t.top=a,t.bottom=-a,t.left=-a*n,t.right=a*n,t.near=u-c,t.far=u+c,t.updateProjectionMatrix(),t.updateMatrixWorld()}orbit(t,e){this.set({turn:this.aim.turn+t,rise:Math.max(-90,Math.min(90,this.aim.rise+e))})}pan(t,e){let{up:n,right:s}=this.frame(),r=2*this.aim.half;this.set({target:ce(ce(this.aim.target,s,-t*r),n,e*r)})}zoom(t,e=0,n=0){let s=Math.min(20*this.radius+this.beyond,Math.max(1e-4*this.radius,this.aim.half/t)),{up:r,right:o}=this.frame(),l=this.aim.half-s;this.set({half:s,target:ce(ce(this.aim.target,o,e*l*this.aspect),r,n*l)})}show(t,e){this.aim=this.fitted(t,e),this.apply()}set(t){this.moved=!0,cancelAnimationFrame(this.flight),this.aim={...this.aim,...t},this.apply()}fly(t){this.moved=!0,cancelAnimationFrame(this.flight);let e=this.aim,n={...e,...t},s=(n.turn-e.turn+540)%360-180;if(matchMedia("(prefers-reduced-motion: reduce)").matches)return this.set(t);let r=performance.now(),o=l=>{let a=Math.min(1,(l-r)/Wv),c=a*a*(3-2*a);this.aim={target:He(e.target,1-c,n.target,c),turn:a===1?n.turn:e.turn+c*s,rise:e.rise+c*(n.rise-e.rise),half:e.half*(n.half/e.half)**c},this.apply(),a<1&&(this.flight=requestAnimationFrame(o))};this.flight=requestAnimationFrame(o)}facing(t){let[e,n,s]=[It(t,this.x),It(t,this.y),It(t,this.z)],r=Math.hypot(e,n);return{turn:r>.001?Math.atan2(n,e)*fn:this.aim.turn,rise:Math.atan2(s,r)*fn}}towards(t){let{turn:e,rise:n}=this.facing(t);return{turn:e+28,rise:Math.max(-65,Math.min(55,n>25?n-22:n+12))}}};var Xv=400,qv=.04,Mp=[[.437,.771,.463],[-.623,.217,.751],[.283,-.859,-.427]].map(([i,t,e])=>new N(i,t,e).normalize());function Sp(i,t){let{low:e,high:n}=i.meta.part,[s,r]=[0,0];for(let o=1;o<=Xv;o++){let l=[2,3,5].map((u,h)=>e[h]+(n[h]-e[h])*Yv(o,u)),c=Mp.map(u=>i.tree.raycast(new In(new N(...l),u),ye).filter(({face:f})=>f&&t(i.owner[f.a])).length%2).reduce((u,h)=>u+h,0);s+=c>0?1:0,r+=c>0&&c<Mp.length?1:0}return r<=Math.max(1,qv*s)}function Yv(i,t){let[e,n]=[0,1/t];for(let s=i;s>0;s=Math.floor(s/t))e+=s%t*n,n/=t;return e}var ei={plane:{value:new me(0,0,0,1)},ratio:{value:1}},$v=`
in vec2 texel;
in vec4 sheet;
in float owner;
out vec3 vNormal;
out vec3 vPlace;
out vec2 vTexel;
flat out vec4 vSheet;
flat out float vOwner;
void main() {
  vPlace = position;
  vSheet = sheet;
  vNormal = normalMatrix * normal;
  vTexel = texel;
  vOwner = owner;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`,bp=`
vec3 lit(vec3 colour, vec3 normal) {
  vec3 n = normalize(normal);
  if (!gl_FrontFacing) n = -n;
  float head = clamp(n.z, 0.0, 1.0);
  float sky = 0.5 + 0.5 * dot(n, normalize(vec3(-0.35, 0.8, 0.45)));
  return colour * (0.56 + 0.28 * head + 0.2 * sky);
}`,Zv=`
float ink(int pattern, vec2 p) {
  float d = p.x + p.y;
  float e = p.x - p.y;
  if (pattern == 1) return step(mod(d, 8.0), 1.9);
  if (pattern == 2) { vec2 q = mod(p, 6.0) - 3.0; return step(dot(q, q), 2.6); }
  if (pattern == 3) return max(step(mod(d, 9.0), 1.5), step(mod(e, 9.0), 1.5));
  if (pattern == 4) return step(mod(p.y, 6.0), 1.6);
  if (pattern == 5) return step(mod(p.x, 6.0), 1.6);
  if (pattern == 6) return step(mod(e, 8.0), 1.9);
  return 0.0;
}`,Jv=`
vec4 told(vec2 at) {
  return texelFetch(colours, ivec2(clamp(at, vSheet.xy, vSheet.zw)), 0);
}
float votes(vec4 of, vec2 own, vec2 f) {
  float sum = 0.0;
  for (int i = 0; i < 9; i++) {
    vec2 step = vec2(i % 3 - 1, i / 3 - 1);
    vec2 side = 0.5 + step * f;
    vec2 weight = mix(0.75 - f * f, 0.5 * side * side, step * step);
    if (told(own + step) == of) sum += weight.x * weight.y;
  }
  return sum;
}
vec4 voted(vec2 place) {
  vec2 at = clamp(place, vSheet.xy, vSheet.zw);
  vec2 own = floor(at + 0.5);
  vec2 f = at - own;
  vec2 way = vec2(f.x < 0.0 ? -1.0 : 1.0, f.y < 0.0 ? -1.0 : 1.0);
  vec4 best = told(own);
  vec4 beside = told(own + vec2(way.x, 0.0));
  vec4 below = told(own + vec2(0.0, way.y));
  vec4 across = told(own + way);
  if (beside == best && below == best && across == best) return best;
  float most = votes(best, own, f);
  if (most >= 0.5) return best;
  for (int i = 0; i < 3; i++) {
    vec4 other = i == 0 ? beside : i == 1 ? below : across;
    float sum = votes(other, own, f);
    if (sum > most) { most = sum; best = other; }
  }
  return best;
}`,Kv=`
precision highp float;
uniform sampler2D colours;
uniform vec3 plain;
uniform vec3 fixed_;
uniform float hot;
uniform float held;
uniform vec4 plane;
uniform float ratio;
in vec3 vNormal;
in vec3 vPlace;
in vec2 vTexel;
flat in vec4 vSheet;
flat in float vOwner;
out vec4 colour;
${bp}
${Zv}
${Jv}
void main() {
  if (dot(plane.xyz, vPlace) > plane.w) discard;
  vec3 base = vOwner < 0.0 ? fixed_ : plain;
  int pattern = 0;
  bool faded = false;
  if (vTexel.x >= -0.5) {
    vec4 found = voted(vTexel);
    base = found.rgb;
    pattern = int(found.a * 255.0 + 0.5);
    if (pattern == 255) { base = plain; pattern = 0; }
    // As in part.ts.
    faded = pattern >= 64;
    pattern = pattern % 64;
  }
  float dark = ink(pattern, gl_FragCoord.xy / ratio);
  base = mix(base, base * 0.42, dark);
  vec3 seen = lit(base, vNormal);
  if (faded) seen = mix(seen, lit(vec3(0.93), vNormal), 0.78);
  if (abs(vOwner - held) < 0.25) seen = mix(seen, vec3(1.0, 0.25, 0.6), 0.12);
  if (abs(vOwner - hot) < 0.25) seen = mix(seen, vec3(1.0, 0.97, 0.75), 0.5);
  colour = vec4(seen, 1.0);
}`,co=1e9;function wp(i,t){let e=n=>new N(...oi(n).map(s=>s/255));return new je({glslVersion:bi,vertexShader:$v,fragmentShader:Kv,side:ye,uniforms:{...ei,colours:{value:null},plain:{value:e(i)},fixed_:{value:e(t)},hot:{value:co},held:{value:co}},polygonOffset:!0,polygonOffsetFactor:1,polygonOffsetUnits:1})}var Qv=`
precision highp float;
uniform vec3 tint;
uniform float opacity;
in vec3 vNormal;
out vec4 colour;
${bp}
void main() {
  colour = vec4(lit(tint, vNormal), opacity);
}`,jv=`
out vec3 vNormal;
void main() {
  vNormal = normalMatrix * normal;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;function er(i,t={}){return new je({glslVersion:bi,vertexShader:`
out vec3 vPlace;
void main() {
  vPlace = position;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`,fragmentShader:`
precision highp float;
uniform vec4 plane;
in vec3 vPlace;
out vec4 colour;
void main() {
  if (dot(plane.xyz, vPlace) > plane.w) discard;
  colour = vec4(${i});
}`,uniforms:{...ei},...t})}function Ap(){return er("1.0, 1.0, 1.0, 1.0",{depthTest:!1,depthWrite:!1,side:ye})}function Tp(){return new je({glslVersion:bi,vertexShader:"void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }",fragmentShader:`
precision highp float;
uniform sampler2D mask;
uniform float ratio;
out vec4 colour;
float at(vec2 away) {
  ivec2 most = textureSize(mask, 0) - 1;
  return texelFetch(mask, clamp(ivec2(gl_FragCoord.xy + away), ivec2(0), most), 0).r;
}
bool border(float radius) {
  float sum = 0.0;
  for (int i = 0; i < 8; i++) sum += at(radius * vec2(cos(0.7854 * float(i)), sin(0.7854 * float(i))));
  return sum > 0.5 && sum < 7.5;
}
void main() {
  if (!border(2.6 * ratio)) discard;
  colour = border(1.5 * ratio) ? vec4(0.69, 0.0, 0.37, 1.0) : vec4(1.0, 1.0, 1.0, 0.85);
}`,uniforms:{...ei,mask:{value:null}},transparent:!0,depthTest:!1,depthWrite:!1})}function ch(i){return new je({glslVersion:bi,vertexShader:jv,fragmentShader:Qv,uniforms:{tint:{value:new N(...oi(i).map(t=>t/255))},opacity:{value:1}}})}function Ep(){let i=ch("#ffffff");return i.uniforms.opacity.value=.3,i.transparent=!0,i.depthFunc=Vs,i.depthWrite=!1,i}function Rp(){return er("0.0, 0.0, 0.0, 0.0",{colorWrite:!1,depthWrite:!1,depthTest:!1,side:ye,stencilWrite:!0,stencilFunc:Al,stencilFail:no,stencilZFail:no,stencilZPass:no})}function Cp(i){return new je({glslVersion:bi,vertexShader:"void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }",fragmentShader:`
precision highp float;
uniform vec3 tint;
uniform float ratio;
out vec4 colour;
void main() {
  vec2 p = gl_FragCoord.xy / ratio;
  float line = step(mod(p.x - p.y, 7.0), 1.1);
  colour = vec4(tint * (1.0 - 0.22 * line), 1.0);
}`,uniforms:{...ei,tint:{value:new N(...oi(i).map(t=>t/255))}},side:ye,stencilWrite:!0})}function Pp(i,t){let e=new qs(new Uint8Array(4*i*t),i,t,Mn,ln);return e.magFilter=e.minFilter=Ce,e.generateMipmaps=!1,e}var Dl=class{constructor(t){this.app=t;let e=[["","off"],["0","across X"],["1","across Y"],["2","across Z"]];for(let[s,r]of e)this.axis.append(Y("option",{value:s},r));this.axis.addEventListener("change",()=>this.turn()),this.slider.addEventListener("input",()=>this.update());let n=re("Flip",()=>{this.sign=-this.sign,this.update()});this.root.append(Y("legend",{},"Clip"),this.axis,this.slider,this.text,n,this.note),this.update()}app;root=Y("fieldset",{id:"clip"});slider=Y("input",{type:"range",min:0,max:1e3,step:"any",value:500,"aria-label":"Place of the clipping plane"});axis=Y("select",{"aria-label":"Clipping plane"});text=Y("output",{class:"number"});note=Y("span",{class:"hint"});caps=[];counters=[];owners=[];sign=1;built=!1;next(){this.axis.selectedIndex=(this.axis.selectedIndex+1)%this.axis.options.length,this.turn();let t=`${this.axis.selectedOptions[0].text} at ${this.text.value}`;this.app.say(this.on?`Clipped ${t}. ${this.note.textContent}`:"Clipping off")}turn(){this.own=!1,this.on&&(this.sign=this.app.stage.table.frame().back[Number(this.axis.value)]<0?-1:1),this.update()}through(t,e){let s=e.map(Math.abs).map((c,u)=>c+.9*Math.abs(this.app.meta.setup.z[u])),r=s.indexOf(Math.min(...s)),{low:o,high:l}=this.app.meta.part,a=(o[r]+l[r])/2;return this.axis.value=String(r),this.slider.value=String(1e3*(t[r]-o[r])/(l[r]-o[r]||1)),this.sign=t[r]<a?-1:1,this.own=!0,this.update(),Ri(r,this.sign)}release(){this.own&&(this.own=!1,this.axis.value="",this.update())}own=!1;get on(){return this.axis.value!==""}update(){let{low:t,high:e}=this.app.meta.part;for(let s of this.root.querySelectorAll("input, output, button, .hint"))s.hidden=!this.on;let n=ei.plane.value;if(!this.on)n.set(0,0,0,1);else{this.built||this.build();let s=Number(this.axis.value),r=t[s]+(e[s]-t[s])*Number(this.slider.value)/1e3,o=Ri(s,this.sign);n.set(...o,this.sign*r),this.text.value=`${"XYZ"[s]} ${Je(r,4)} mm`;let l=He(t,.5,e,.5);l[s]=r;for(let a of this.caps)a.position.set(...l),a.quaternion.setFromUnitVectors(new N(0,0,1),new N(...o))}this.stand(),this.app.stage.request()}stand(){for(let t of[this.caps,this.counters])t.forEach((e,n)=>e.visible=this.on&&this.app.drawn.there(this.owners[n]))}build(){this.built=!0;let{drawn:t,meta:e,stage:n}=this.app,{low:s,high:r}=e.part,o=[],l=[["the part",0,t.ofFaces,"#8f8577",0]],a=c=>String(e.fixtures[c].setups);e.fixtures.forEach(({start:c,count:u},h)=>{h>0&&a(h)===a(h-1)?l[l.length-1][2]+=u:l.push(["a fixture",c,u,Dn(e,"fixture"),-1-h])}),l.forEach(([c,u,h,f,d],g)=>{if(!h)return;if(!Sp(t,S=>d>=0?S>=0&&!e.faces[S].ignored:S<0&&a(-1-S)===a(-1-d))){o.push(c);return}let p=t.geometry(u,h),m=new de(p,Rp());m.renderOrder=1+.1*g,this.counters.push(m),this.owners.push(d);let x=Cp(f);x.stencilRef=0,x.stencilFunc=Hu,x.stencilFail=x.stencilZFail=x.stencilZPass=Gu;let M=2.2*is(s,r),v=new de(new yi(M,M),x);v.renderOrder=1.05+.1*g,this.caps.push(v)}),n.add(...this.counters,...this.caps),this.note.textContent=o.length?`${o.join(" and ")} is an open surface: it has no cap.`:""}};var uh=class{constructor(t,e){this.bytes=t;this.entries=e}bytes;entries;done=new Map;has(t){return t in this.entries}get(t){let e=this.done.get(t);if(!e){let n=this.entries[t];if(!n)throw new Error(`the page has no array ${t}`);e=eM(this.bytes.subarray(n.offset,n.offset+n.bytes),n),this.done.set(t,e)}return e}};function Ip(){let i=JSON.parse(Np("meta"));if(i.format!==1)throw new Error(`the data have format ${i.format}, this page reads 1`);return i}async function Lp(i,t="data"){let e=tM(Np(t)),n=new Blob([e]).stream().pipeThrough(new DecompressionStream("deflate-raw"));return new uh(new Uint8Array(await new Response(n).arrayBuffer()),i.arrays)}function Np(i){let t=document.getElementById(i);if(!t)throw new Error(`the page has no data "${i}"`);return t.textContent??""}function tM(i){let t=atob(i.trim()),e=new Uint8Array(t.length);for(let n=0;n<t.length;n++)e[n]=t.charCodeAt(n);return e}function eM(i,t){let e=t.shape[0],n=t.shape.length>1?t.shape[1]:1,s=Number(t.dtype[1]),r=e*n;if(i.length!==r*s)throw new Error(`an array of ${r} values has ${i.length} bytes`);let o;if(s===1)o=i.slice();else{let a=new Uint8Array(r*s);for(let c=0;c<s;c++){let u=i.subarray(c*r,(c+1)*r);for(let h=0;h<r;h++)a[h*s+c]=u[h]}o=s===2?new Uint16Array(a.buffer):new Uint32Array(a.buffer)}if(t.filter.endsWith("_z"))for(let a=0;a<r;a++)o[a]=o[a]>>>1^-(o[a]&1);let l=t.filter.startsWith("delta2")?2:t.filter.startsWith("delta")?1:0;for(let a=0;a<l;a++)for(let c=0;c<n;c++)for(let u=c*e+1;u<(c+1)*e;u++)o[u]+=o[u-1];return t.dtype==="i2"&&(o=new Int16Array(o.buffer)),t.dtype==="i4"&&(o=new Int32Array(o.buffer)),t.dtype==="f2"&&(o=Float32Array.from(o,a=>Or.fromHalfFloat(a))),{rows:e,columns:n,values:o}}function Dp(i){let{triangle:t,position:e}=i,n=new Map,s=e.length/3,r=nM(i);for(let c=0;c<t.length;c+=3)for(let u=0;u<3;u++){let h=r[t[c+u]],f=r[t[c+(u+1)%3]];if(h===f)continue;let d=Math.min(h,f)*s+Math.max(h,f);n.set(d,(n.get(d)??0)+1)}let o=[];for(let[c,u]of n)u===1&&o.push(Math.floor(c/s),c%s);let l=new Xe;l.setAttribute("position",new Ae(e,3)),l.setIndex(o);let a=new kr(l,er("0.09, 0.11, 0.13, 0.75",{transparent:!0}));return a.renderOrder=.5,a}function nM({cell:i,owner:t}){let e=new Int32Array(t.length),[n,s]=[Number.NaN,new Map];for(let r=0;r<t.length;r++){t[r]!==n&&([n,s]=[t[r],new Map]);let o=s.get(i[r]);e[r]=o??r,o===void 0&&s.set(i[r],r)}return e}var iM=300,sM=1.3;function Up(i){let{samples:t,cutter:e,picker:n}=i,{table:s}=i.stage,r=[];for(let p=0;p<t.count;p++){let m=t.verdict(e.id,p);(m==="inaccessible"||m==="undecided")&&r.push(p)}if(!r.length)return;let o=Math.max(1,Math.floor(r.length/iM)),l=r.filter((p,m)=>m%o===0).map(p=>({area:t.area(p),point:t.point(p),normal:t.normal(p)})),a=(p,m)=>s.frame({...s.aim,turn:p,rise:m}).back,c=p=>l.reduce((m,{area:x,normal:M})=>m+x*Math.max(0,It(p,M)),0),u=p=>l.reduce((m,{area:x,point:M,normal:v})=>{let S=It(p,v);return S>.1&&!n.hidden(M,p)?m+x*S:m},0),h=s.aim,d=[32,-32,75].flatMap(p=>Array.from({length:8},(m,x)=>({turn:h.turn+45*x,rise:p}))).map(p=>({view:p,front:c(a(p.turn,p.rise))})).sort((p,m)=>m.front-p.front),g=sM*u(a(h.turn,h.rise)),y=null;for(let{view:p,front:m}of d.slice(0,6)){if(m<=g)continue;let x=u(a(p.turn,p.rise));x>g&&([g,y]=[x,p])}y&&s.show(y.turn,y.rise)}var rM=.5,oM=80;function Ul(i,t,e,n=hh(i)){i.stage.table.fly({target:t,half:n,...Bp(i,[t],e,null)})}function hh({cutter:i,drawn:{partRadius:t}}){return Math.min(.7*t,Math.max(6*i.radius,.08*t))}var Fp=!1,Op=()=>Fp;function Fl(i,t=!1){let{sample:e,stage:{table:n}}=i;if(!e)return;Fp=t;let s=i.inTheWay()?.point??null,r=i.toolShown?i.placed():null,o=r?.axis??null,l=Bp(i,s?[e.point,s]:[e.point],e.normal,o),a=t?.35*hh(i):hh(i),c=(h,f)=>({centre:h,radius:f,axis:null}),u=[c(e.point,a),...s?[c(s,.3*a)]:[]];r&&!t&&u.push(...aM(i,r.tip,r.axis)),n.fly(n.holding(l.turn,l.rise,r||t?u:[c(e.point,a)]))}function aM({cutter:i},t,e){return i.outline.flatMap(({points:n})=>n.map(([s,r])=>({centre:ce(t,e,r),radius:s,axis:e})))}function Bp(i,t,e,n){let{table:s}=i.stage,r=s.towards(e),o=g=>s.frame({...s.aim,...g}).back,l=o(r),a=g=>It(g,l)-(n?1.5*Math.max(0,Math.abs(It(g,n))-rM):0),c=[r];for(let g=0;g<360;g+=15)for(let y=-75;y<=85;y+=10)c.push({turn:g,rise:y});let u=c.map(g=>({view:g,way:o(g)})).filter(({way:g})=>It(g,e)>.1).sort((g,y)=>a(y.way)-a(g.way)),h=(g,y)=>u.slice(0,g).find(({way:p})=>!y.some(m=>i.picker.hidden(m,p)))?.view,f=(t.length>1?h(oM,t):void 0)??h(u.length,t.slice(0,1));if(f||!i.clip)return f??r;let d=i.clip.through(t[0],e);return i.note="It is hidden from every side: the part is clipped there.",s.towards(d)}var zp=[["Click, Enter","show the posture map of the sample there (Enter: in the middle of the picture)"],["Ctrl and click, s","select the face there (s: of the pointer or the sample), to copy it for --faces"],["Drag, arrows","turn the part (in the posture map: move the tool)"],["Shift and drag, Ctrl and arrows","shift the picture"],["Wheel, + and -","zoom"],["f","fit the part into the picture"],["1 to 7","front, back, left, right, top, bottom, corner"],["Shift and arrows, j and k","step to a neighbouring sample"],["n and p","next and previous worst spot"],["[ and ]","previous and next cutter"],["z","look closely at the sample shown, or at all of its tool"],["t","show or hide the tool"],["g","see through the tool, or not"],["c","clip: off, across X, Y, Z"],["m","measure: between two points, or from the selected sample to the next one"],["Escape","leave the sample, end measuring"],["?","this help"]],lM=["o","show verdicts, or the operations of a plan"];function Vp(i){let t=[...zp.slice(0,10),...li(i).length?[lM]:[],...zp.slice(10)].map(([n,s])=>Y("tr",{},Y("th",{scope:"row"},n),Y("td",{},s))),e=Y("dialog",{id:"help","aria-labelledby":"help-title"});return e.append(Y("h2",{id:"help-title"},"Mouse and keys"),Y("table",{},Y("tbody",{},...t)),re("Close",()=>e.close())),e}function Gp(i,t){let{table:e}=i.stage;document.addEventListener("keydown",s=>{let r=s.target;if(s.defaultPrevented||s.altKey||s.metaKey||t.help.open||r.closest("input, select, textarea")||r.isContentEditable)return;if(n(s,r)){s.preventDefault();return}if(s.ctrlKey)return;let o=lo[s.key];if(o){e.fly(e.fitted(o[1],o[2])),i.say(`View: ${o[0]}`);return}({"+":()=>e.zoom(1.25),"=":()=>e.zoom(1.25),"-":()=>e.zoom(.8),f:()=>e.fly(e.fitted(e.aim.turn,e.aim.rise)),n:()=>t.spots.step(1),p:()=>t.spots.step(-1),j:()=>fh(i,1),k:()=>fh(i,0),"[":()=>kp(i,-1),"]":()=>kp(i,1),c:()=>t.clip.next(),m:()=>t.measure.toggle(),s:()=>t.selection.toggle(i.hot??i.faceShown()),o:()=>li(i.meta).length?af(i):void 0,z:()=>cM(i),t:t.tool,g:t.glass,"?":()=>t.help.showModal(),Escape:()=>t.measure.on?t.measure.toggle():i.select(null)})[s.key]?.()});let n=(s,r)=>{let l={ArrowLeft:[-1,0,0],ArrowRight:[1,0,1],ArrowUp:[0,1,3],ArrowDown:[0,-1,2]}[s.key];if(!l||r!==i.stage.canvas)return!1;let[a,c,u]=l;return s.shiftKey?fh(i,u):s.ctrlKey?e.pan(-.08*a,.08*c):e.orbit(8*a,8*c),!0}}function fh(i,t){let{sample:e}=i;if(!e){i.say("No sample is selected: press Enter in the picture");return}let n=i.part.neighbours(e.row)[t];if(n===null||i.samples.face.values[n]!==e.face){i.say("The face ends there");return}i.select(n)}function cM(i){if(!i.sample)return i.say("No sample is selected: press Enter in the picture");i.note="";let t=!Op();Fl(i,t),i.say(`${t?"A close look":"All of the tool"}. ${i.note}`)}function kp(i,t){let{cutters:e}=i.meta,n=e.indexOf(i.cutter);i.setCutter(e[(n+t+e.length)%e.length].id)}var uM=.75,[hM,fM,dM]=[.3,88,180],[dh,Hp]=[8,34],Wp=24,Ol=class{constructor(t){this.app=t;this.root.append(this.marks),this.root.addEventListener("click",()=>{let{table:e}=t.stage;e.fly(e.fitted(e.aim.turn,e.aim.rise))}),t.stage.afterDraw(()=>this.draw())}app;root=Y("button",{id:"inset",type:"button",title:"Show the whole part (f)","aria-label":"Show the whole part",hidden:!0});marks=$t("svg",{"aria-hidden":"true"});camera=new Gi;draw(){let{canvas:t,renderer:e,scene:n,table:s}=this.app.stage,[r,o]=[t.clientWidth,t.clientHeight],{aim:l}=s,a=Math.round(Math.min(dM,Math.max(fM,hM*Math.min(r,o))));if(this.root.hidden=l.half>uM*s.fitted(l.turn,l.rise).half||a>.6*r,this.root.hidden)return;let c=s.fitted(l.turn,l.rise,1);s.point(this.camera,c,1);let u=this.covers(a,r,o);this.root.classList.toggle("left",u);let[h,f]=[u?dh:r-a-dh,o-a-Hp];e.setViewport(h,f,a,a),e.setScissor(h,f,a,a),e.setScissorTest(!0),e.render(n,this.camera),e.setScissorTest(!1),e.setViewport(0,0,r,o),this.mark(a,c)}covers(t,e,n){let{sample:s,stage:r}=this.app;if(!s)return!1;let{aim:o}=r.table,{right:l,up:a}=r.table.frame(o),c=Rn(s.point,o.target),u=n/(2*o.half),[h,f]=[e/2+u*It(c,l),n/2-u*It(c,a)];return h>e-t-dh-Wp&&f<Hp+t+Wp}mark(t,e){let{sample:n,stage:s}=this.app,{aim:r,aspect:o}=s.table,{right:l,up:a}=s.table.frame(r),c=t/(2*e.half),u=x=>{let M=Rn(x,e.target);return[t/2+c*It(M,l),t/2-c*It(M,a)]},[h,f]=u(r.target),[d,g]=[c*r.half*o,c*r.half],y={x:h-d,y:f-g,width:2*d,height:2*g},p=n&&u(n.point),m=p?{cx:p[0],cy:p[1],r:4}:null;this.root.style.setProperty("--side",`${t}px`),this.marks.replaceChildren($t("rect",{class:"under",...y}),$t("rect",{class:"seen",...y}),...m?[$t("circle",{class:"under",...m}),$t("circle",{class:"sample",...m})]:[])}};var nr=matchMedia("(max-width: 999.98px)");function Xp(i){let t=Y("div",{}),e=Y("summary",{},"Legend"),n=Y("details",{open:!nr.matches},e,t);return nr.addEventListener("change",()=>n.open=!nr.matches),i.on("look",()=>{e.textContent=i.look?.title??"Legend",t.replaceChildren(...ph(i,!1))}),Y("aside",{id:"legend","aria-label":"Legend"},n)}function ph({look:i,meta:t},e=!0){if(!i)return[];let n=i.entries.map(a=>Y("li",{},es(a.colour,a.pattern),a.label,Y("span",{class:"share"},bo(a.share??0)))),s=a=>{n.push(Y("li",{},es(Dn(t,a),"plain"),be(t,a)))};t.faces.some(a=>!a.target)&&s("check"),t.fixtures.length&&s("fixture");let r=e?[Y("h2",{},i.title)]:[];i.ramp&&r.push(pM(i.ramp)),r.push(Y("ul",{class:"legend"},...n));let l=`share of the sampled area${i.entries.some(a=>a.label===be(t,"inside_bodies"))?" that lies inside no other body":""}`;return i.entries.length&&r.push(Y("p",{class:"hint"},l)),r}function pM({low:i,high:t,unit:e,below:n,above:s}){let o=$t("svg",{class:"ramp",viewBox:"0 0 64 10",preserveAspectRatio:"none","shape-rendering":"crispEdges","aria-hidden":"true"});for(let a=0;a<64;a++)o.append($t("rect",{x:a,y:0,width:1.05,height:10,fill:Ro(a/63)}));let l=(i+t)/2;return Y("div",{class:"scale"},o,Y("p",{class:"ticks"},Y("span",{},`${n?"\u2264 ":""}${Je(i)}`),Y("span",{},Je(l)),Y("span",{},`${s?"\u2265 ":""}${Je(t)} ${e}`)))}var mM=24;function qp(i){let t=document.querySelector("#cutters table"),e=[...document.querySelectorAll("#cutters tr[data-cutter]")].filter(c=>i.meta.cutters.some(u=>u.id===c.dataset.cutter)),n=c=>c.dataset.cutter===i.cutter.id,s=new Map,r=new Map,o=(c,u)=>{let h=Ms(c);h&&(h.hidden=!u),r.get(c)?.setAttribute("aria-expanded",String(u))},l=c=>i.setCutter(c.dataset.cutter);for(let c of e){let u=c.querySelector("th, td")??c,h=Ms(c),f=u.textContent.trim(),d=ns(u,()=>l(c));if(u.classList.toggle("short",f.length<=mM),s.set(c,d),h){let g=re("",()=>o(c,!!h.hidden),{class:"opener","aria-label":`Details of ${f}`,"aria-controls":h.id,title:"Details"});r.set(c,g),u.prepend(g)}for(let g of[c,h])g?.addEventListener("click",y=>{y.target.closest("button, a, summary")||l(c)})}let a=()=>{for(let c of e){let u=n(c);if(c.classList.toggle("shown",u),Ms(c)?.classList.toggle("shown",u),s.get(c).setAttribute("aria-pressed",String(u)),o(c,u),!u||c.previousElementSibling===null)continue;let h=c.contains(document.activeElement)?document.activeElement:null,f=Ms(c);c.parentElement.prepend(...f?[c,f]:[c]),h?.focus({preventScroll:!0})}for(let c of document.querySelectorAll("#cutters details[data-cutter]"))c.open=c.dataset.cutter===i.cutter.id,c.hidden=!c.open};i.on("cutter",a),a(),t&&e.length>1&&Ic(t,n)}var Bl=class{constructor(t){this.app=t;for(let s of this.items)ns(s,()=>this.show(s));let e=document.getElementById("spots");this.items.length&&e?.append(this.none);let n=e?.querySelector("h2");n&&this.items.length&&n.after(Y("p",{class:"tools"},re("Previous",()=>this.step(-1),{title:"Previous spot (p)"}),re("Next",()=>this.step(1),{title:"Next spot (n)"}))),t.on("cutter",()=>this.filter()),t.on("sample",()=>this.mark()),this.filter()}app;items=[...document.querySelectorAll("#spots [data-spot]")];none=Y("p",{class:"hint"},"The cutter that is shown has none.");at=-1;get mine(){return this.items.filter(t=>t.dataset.cutter===this.app.cutter.id)}filter(){this.at=-1;for(let t of document.querySelectorAll("#spots details[data-cutter]"))t.hidden=t.dataset.cutter!==this.app.cutter.id,t.open=!t.hidden;this.none.hidden=this.mine.length>0}mark(){for(let t of this.items){let e=this.app.spot!==null&&this.app.meta.spots[Number(t.dataset.spot)]===this.app.spot;t.classList.toggle("shown",e),e&&(this.at=this.mine.indexOf(t))}}step(t){let{mine:e}=this;if(!e.length){this.app.say("This cutter has no worst spots");return}this.at=this.at<0?t>0?0:e.length-1:(this.at+t+e.length)%e.length,this.show(e[this.at])}show(t){let e=this.app.meta.spots[Number(t.dataset.spot)];e&&(this.app.select(e.sample,e),t.scrollIntoView({block:"nearest"}),this.app.note="",this.app.clip?.release(),Fl(this.app),this.app.say(`Spot ${this.at+1} of ${this.mine.length}: ${e.face}, ${be(this.app.meta,e.reason)}. ${this.app.note}`))}},zl=class{constructor(t){this.app=t;let{faces:e}=t.meta;for(let n of document.querySelectorAll("tr[data-face]")){let s=e.findIndex(l=>l.number===Number(n.dataset.face));if(s<0)continue;n.closest("#faces")?this.rows.set(s,n):this.others.set(n,s);let r=n.querySelector("th, td")??n,o=ns(r,()=>this.show(s));n.addEventListener("pointerenter",()=>t.hover(s,!0)),n.addEventListener("pointerleave",()=>t.hover(null)),o.addEventListener("focus",()=>t.hover(s,!0)),o.addEventListener("blur",()=>t.hover(null))}t.on("hot",()=>{for(let[n,s]of this.rows)s.classList.toggle("hot",n===t.hot);for(let[n,s]of this.others)n.classList.toggle("hot",s===t.hot)}),this.tools(),this.table&&Ic(this.table)}app;rows=new Map;others=new Map;table=document.querySelector("#faces table");show(t){let{app:e}=this,n=e.drawn.middle(t),s=e.meta.faces[t];if(!n)return e.say(`${s.id} is not drawn`);let r=e.drawn.triangle[3*(s.start+(s.count>>1))],o=[0,1,2].map(l=>e.drawn.normal[4*r+l]);Ul(e,n.centre,o,1.4*n.radius),e.say(`${s.id}${s.name?`, ${s.name}`:""}`)}tools(){if(!this.table||this.rows.size<6)return;let e=Y("input",{type:"search",...{"aria-label":"Show faces that contain",placeholder:"Filter faces, such as F12"}}),n=Y("span",{class:"hint","aria-live":"polite"});e.addEventListener("input",()=>{let s=e.value.trim().toLowerCase(),r=0;for(let o of this.rows.values())o.hidden=!o.textContent.toLowerCase().includes(s),r+=o.hidden?0:1;n.textContent=s?`${r} of ${this.rows.size}`:""}),this.table.before(Y("p",{class:"tools"},e,n))}};var kl=class{constructor(t){this.app=t;t.stage.beforeDraw(()=>this.draw()),this.add(()=>{let{sample:e}=t;if(!e)return[];let{point:n=null,owner:s=null}=t.inTheWay()??{},r=s===null?"":`in the way: ${t.drawn.called(s)}`;return[...n?[{kind:"obstacle",points:[e.point,n],label:r}]:[],{kind:"sample",points:[e.point]}]})}app;root=$t("svg",{class:"marks","aria-hidden":"true"});from=[];add(t){this.from.push(t)}draw(){this.root.replaceChildren(...this.from.flatMap(t=>t()).flatMap(t=>this.shapes(t)))}shapes({kind:t,points:e,label:n}){let s=e.map(o=>this.app.stage.project(o)),r=[];if(s.length>1){let[[o,l],[a,c]]=s;r.push($t("line",{class:"under",x1:o,y1:l,x2:a,y2:c}),$t("line",{class:t,x1:o,y1:l,x2:a,y2:c}))}if(s.forEach(([o,l],a)=>{if(t==="obstacle"&&a===0)return;let c=`M${o-6} ${l-6}L${o+6} ${l+6}M${o-6} ${l+6}L${o+6} ${l-6}`;t==="obstacle"?r.push($t("path",{class:"under",d:c}),$t("path",{class:t,d:c})):r.push($t("circle",{class:"under",cx:o,cy:l,r:6}),$t("circle",{class:t,cx:o,cy:l,r:6}))}),n&&s.length>1){let o=s[0][0]>s[1][0]&&s[1][0]>150,[l,a]=t==="obstacle"?[s[1][0]+(o?-12:12),s[1][1]+5]:[(s[0][0]+s[1][0])/2+8,(s[0][1]+s[1][1])/2-8],c={x:l,y:a,"text-anchor":t==="obstacle"&&o?"end":"start"};r.push($t("text",{class:"under",...c},n),$t("text",{class:t,...c},n))}return r}};var Vl=class{constructor(t,e){this.app=t;this.root=re("Measure",()=>this.toggle(),{"aria-pressed":"false",title:"Measure between two points (m)"}),e.add(()=>this.marks()),t.on("sample",()=>{this.on&&t.sample&&this.points.length===1&&this.add(t.sample.point)})}app;root;output=Y("output",{id:"measured"});on=!1;points=[];toggle(){this.on=!this.on,this.points=[],this.root.setAttribute("aria-pressed",String(this.on)),this.output.value="",this.on&&this.app.sample&&(this.points=[this.app.sample.point]),this.app.say(this.on?this.points.length?"Measuring from the selected sample: select the second point":"Measuring: select the first point":"Measuring ends"),this.app.stage.request()}add(t){this.points.length===2&&(this.points=[]),this.points.push(t),this.points.length===2?(this.output.value=this.words(),this.app.say(this.output.value)):(this.output.value="",this.app.say("First point set: select the second one")),this.app.stage.request()}words(){let[t,e]=this.points,[n,s,r]=Rn(e,t).map(o=>Je(o,5));return`distance ${Je(is(t,e),5)} mm, dx ${n}, dy ${s}, dz ${r} mm`}marks(){if(!this.points.length)return[];let t=this.points.length===2?`${Je(is(this.points[0],this.points[1]),5)} mm`:"";return[{kind:"measure",points:this.points,label:t}]}};var Yp="review-notes",$p="notes-data",gM={"<":"\\u003c",">":"\\u003e","&":"\\u0026","\u2028":"\\u2028","\u2029":"\\u2029"},Gl=class{constructor(t,e){this.app=t;this.pristine=e;document.getElementById(Yp)?.replaceChildren(Y("h2",{},"Review notes"),Y("p",{class:"hint"},"Notes are kept in the copy that ",Y("strong",{},"Save copy")," writes, and nowhere else."),this.list,Y("label",{for:"note"},"New note"),this.box,Y("p",{class:"tools"},re("Add note",()=>this.add(),{id:"add-note"}),this.place)),this.box.addEventListener("keydown",s=>{s.key==="Enter"&&(s.ctrlKey||s.metaKey)&&this.add()}),t.on("sample",()=>this.where()),this.where(),this.show(),window.addEventListener("beforeunload",s=>{(!this.saved||this.box.value.trim())&&s.preventDefault()})}app;pristine;notes=_M();saved=!0;list=Y("ol",{class:"notes"});box=Y("textarea",{id:"note",rows:2,"aria-describedby":"note-place"});place=Y("span",{id:"note-place",class:"hint"});saveButton=re("Save copy",()=>this.save(),{id:"save-copy",title:"Save this page with the notes in it"});here=re("Note here",()=>this.box.focus(),{id:"note-here",title:"Write a note on this sample"});where(){let{sample:t}=this.app;this.place.textContent=t?`at ${this.face(t.face)}, sample ${t.row}`:"on the whole: no sample is selected"}face(t){return this.app.meta.faces.find(e=>e.number===t)?.id??`F${t}`}add(){let t=this.box.value.trim();if(!t){this.app.say("The note is empty"),this.box.focus();return}let{sample:e,cutter:n}=this.app;this.notes.push({text:t,face:e&&this.face(e.face),sample:e&&e.row,cutter:e&&n.id}),this.box.value="",this.changed(`Note ${this.notes.length} added: Save copy keeps it`)}remove(t){this.notes.splice(t,1),this.changed(`Note ${t+1} removed`),this.box.focus()}changed(t){this.saved=!1,this.show(),this.app.say(t)}show(){this.list.replaceChildren(...this.notes.map((t,e)=>Y("li",{},t.sample===null?null:re(this.about(t),()=>this.go(t),{class:"text place"}),Y("span",{class:"said"},t.text),re("Remove",()=>this.remove(e),{class:"copy","aria-label":`Remove note ${e+1}`})))),this.saveButton.classList.toggle("unsaved",!this.saved)}go({sample:t,cutter:e}){let{app:n}=this;if(t===null||!(t>=0&&t<n.samples.count))return n.say("The sample of this note is not in the plan");e&&e!==n.cutter.id&&n.meta.cutters.some(s=>s.id===e)&&n.setCutter(e),n.select(t),Ul(n,n.samples.point(t),n.samples.normal(t))}about({face:t,sample:e,cutter:n}){let s=this.app.meta.cutters.find(r=>r.id===n);return`${t??"?"}, sample ${e}${s?`, ${s.name||s.id}`:""}`}copy(){let t=this.pristine.cloneNode(!0),e=t.querySelector(`#${$p}`);if(!e)throw new Error("the page has no place for notes");e.textContent=JSON.stringify(this.notes).replace(/[<>&\u2028\u2029]/g,s=>gM[s]);let n=this.notes.map(s=>Y("li",{},s.sample===null?"":`${this.about(s)}: `,s.text));return t.querySelector(`#${Yp}`)?.replaceChildren(...n.length?[Y("h2",{},"Review notes"),Y("ol",{},...n)]:[]),`<!doctype html>
${t.outerHTML}
`}save(){this.box.value.trim()&&this.add();let t=Y("a",{href:URL.createObjectURL(new Blob([this.copy()],{type:"text/html"})),download:xM(location.pathname)});document.body.append(t),t.click(),t.remove(),setTimeout(()=>URL.revokeObjectURL(t.href),6e4),this.saved=!0,this.show(),this.app.say(`Saved as ${t.download}, where this browser keeps downloads`)}};function xM(i){let t=i.split("/").pop()??"";try{t=decodeURIComponent(t)}catch{}return`${t.replace(/\.html?$/i,"").replace(/-notes$/,"")||"review"}-notes.html`}function _M(){let i=JSON.parse(document.getElementById($p)?.textContent||"[]");return(Array.isArray(i)?i:[]).filter(e=>typeof e?.text=="string").map(({text:e,face:n,sample:s,cutter:r})=>({text:e,face:typeof n=="string"?n:null,sample:Number.isInteger(s)?s:null,cutter:typeof r=="string"?r:null}))}var ir=Math.pow(2,-24),uo=Symbol("SKIP_GENERATION"),Hl={strategy:0,maxDepth:40,targetLeafSize:10,useSharedArrayBuffer:!1,setBoundingBox:!0,onProgress:null,indirect:!1,verbose:!0,range:null,[uo]:!1};function ue(i,t,e){return e.min.x=t[i],e.min.y=t[i+1],e.min.z=t[i+2],e.max.x=t[i+3],e.max.y=t[i+4],e.max.z=t[i+5],e}function ho(i){let t=-1,e=-1/0;for(let n=0;n<3;n++){let s=i[n+3]-i[n];s>e&&(e=s,t=n)}return t}function mh(i,t,e){for(let n=0;n<3;n++){let s=t[i+2*n],r=t[i+2*n+1],o=s-r,l=s+r;o<e[n]&&(e[n]=o),l>e[n+3]&&(e[n+3]=l)}}function Wl(i){let t=i[3]-i[0],e=i[4]-i[1],n=i[5]-i[2];return 2*(t*e+e*n+n*t)}function Jt(i,t){return t[i+15]===65535}function ie(i,t){return t[i+6]}function oe(i,t){return t[i+14]}function te(i){return i+8}function ee(i,t){let e=t[i+6];return i+e*8}function sr(i,t){return t[i+7]}function Xl(i,t,e,n,s){let r=1/0,o=1/0,l=1/0,a=-1/0,c=-1/0,u=-1/0,h=1/0,f=1/0,d=1/0,g=-1/0,y=-1/0,p=-1/0,m=i.offset||0;for(let x=(t-m)*6,M=(t+e-m)*6;x<M;x+=6){let v=i[x+0],S=i[x+1],A=v-S,_=v+S;A<r&&(r=A),_>a&&(a=_),v<h&&(h=v),v>g&&(g=v);let b=i[x+2],L=i[x+3],E=b-L,C=b+L;E<o&&(o=E),C>c&&(c=C),b<f&&(f=b),b>y&&(y=b);let I=i[x+4],U=i[x+5],P=I-U,B=I+U;P<l&&(l=P),B>u&&(u=B),I<d&&(d=I),I>p&&(p=I)}n[0]=r,n[1]=o,n[2]=l,n[3]=a,n[4]=c,n[5]=u,s[0]=h,s[1]=f,s[2]=d,s[3]=g,s[4]=y,s[5]=p}var ii=8,xh=8,gh=new Int32Array(ii),ni=new Float32Array(ii*6),rr=new Float32Array(ii*6),Xn=new Float32Array(6),ql=new Float32Array(6),Wi=new Int32Array(xh),Jp=new Float32Array(xh*6);function MM(i,t,e,n){for(let s=0;s<3;s++){let r=t[i+2*s],o=t[i+2*s+1],l=r-o,a=r+o;l<e[n+s]&&(e[n+s]=l),a>e[n+s+3]&&(e[n+s+3]=a)}}function Kp(i,t){let e=i[t+3]-i[t],n=i[t+4]-i[t+1],s=i[t+5]-i[t+2];return 2*(e*n+n*s+s*e)}function Qp(i,t,e,n,s,r){let o=-1,l=0;if(r===0)o=ho(t),o!==-1&&(l=(t[o]+t[o+3])/2);else if(r===1)o=ho(i),o!==-1&&(l=SM(e,n,s,o));else if(r===2){let a=Wl(i),c=1.25*s,u=e.offset||0,h=(n-u)*6,f=(n+s-u)*6;for(let d=0;d<3;d++){let g=t[d],m=(t[d+3]-g)/ii;if(s<xh){for(let x=0;x<s;x++){let M=h+x*6,v=e[M+2*d],S=x;for(;S>0&&e[Wi[S-1]+2*d]>v;)Wi[S]=Wi[S-1],S--;Wi[S]=M}for(let x=0;x<3;x++)Xn[x]=1/0,Xn[x+3]=-1/0,ql[x]=1/0,ql[x+3]=-1/0;for(let x=s-1;x>=0;x--)mh(Wi[x],e,ql),Jp.set(ql,x*6);for(let x=0;x<s-1;x++){mh(Wi[x],e,Xn);let M=e[Wi[x+1]+2*d];if(e[Wi[x]+2*d]===M)continue;let v=x+1,S=s-v,A=Wl(Xn)/a,_=Kp(Jp,v*6)/a,b=1+1.25*(A*v+_*S);b<c&&(o=d,c=b,l=M)}}else{for(let v=0;v<ii;v++){gh[v]=0;for(let S=0;S<3;S++)ni[v*6+S]=1/0,ni[v*6+S+3]=-1/0}for(let v=h;v<f;v+=6){let _=~~((e[v+2*d]-g)/m);_>=ii&&(_=ii-1),gh[_]++,MM(v,e,ni,_*6)}let x=(ii-1)*6;for(let v=0;v<6;v++)rr[x+v]=ni[x+v];for(let v=ii-2;v>=0;v--){let S=v*6,A=S+6;for(let _=0;_<3;_++)rr[S+_]=Math.min(ni[S+_],rr[A+_]),rr[S+_+3]=Math.max(ni[S+_+3],rr[A+_+3])}let M=0;for(let v=0;v<ii-1;v++){let S=v*6,A=gh[v];if(A!==0)for(let C=0;C<3;C++)M===0?(Xn[C]=ni[S+C],Xn[C+3]=ni[S+C+3]):(Xn[C]=Math.min(Xn[C],ni[S+C]),Xn[C+3]=Math.max(Xn[C+3],ni[S+C+3]));M+=A;let _=0,b=0;M!==0&&(_=Wl(Xn)/a);let L=s-M;L!==0&&(b=Kp(rr,S+6)/a);let E=1+1.25*(_*M+b*L);E<c&&(o=d,c=E,l=g+m+v*m)}}}}else console.warn(`BVH: Invalid build strategy value ${r} used.`);return{axis:o,pos:l}}function SM(i,t,e,n){let s=0,r=i.offset;for(let o=t,l=t+e;o<l;o++)s+=i[(o-r)*6+n*2];return s/e}function jp(i,t,e,n,s,r){let o=n,l=n+s-1,a=r.pos,c=r.axis*2,u=e.offset||0;for(;;){for(;o<=l&&e[(o-u)*6+c]<a;)o++;for(;o<=l&&e[(l-u)*6+c]>=a;)l--;if(o<l){for(let h=0;h<t;h++){let f=i[o*t+h];i[o*t+h]=i[l*t+h],i[l*t+h]=f}for(let h=0;h<6;h++){let f=o-u,d=l-u,g=e[f*6+h];e[f*6+h]=e[d*6+h],e[d*6+h]=g}o++,l--}else return o}}var bM=Math.pow(2,32),or=new Float32Array(6),Yl=new Float32Array(6);function wM(i,t,e,n,s,r){let{maxDepth:o,verbose:l,targetLeafSize:a,_strictLeafSize:c=1/0,strategy:u,onProgress:h,useSharedArrayBuffer:f=!1}=s,d=i.primitiveBuffer,g=i.primitiveBufferStride,y=f?SharedArrayBuffer:ArrayBuffer,p=new y(32*Math.max(1,2*Math.ceil(n)-1)),m=new Float32Array(p),x=new Uint32Array(p),M=new Uint16Array(p),v=0,S=!1;return Xl(t,e,n,or,Yl),b(e,n,0),p.slice(0,v*32);function A(L){h&&h((L-r.offset)/r.count)}function _(L,E,C){let I=L*2;x[L+6]=E,M[I+14]=C,M[I+15]=65535,A(E+C)}function b(L,E,C){let I=v++,U=I*8;m.set(or,U),!S&&C>=o&&(S=!0,l&&console.warn(`BVH: Max depth of ${o} reached when generating BVH. Consider increasing maxDepth.`));let P=E>c;if(E<=a&&!P||C>=o){_(U,L,E);return}let B=Qp(or,Yl,t,L,E,u),H=B.axis===-1?-1:jp(d,g,t,L,E,B);if(B.axis===-1||H===L||H===L+E){if(!P){_(U,L,E);return}B.axis=Math.max(0,ho(or)),H=L+Math.max(1,Math.floor(E/2))}x[U+7]=B.axis;let G=H-L;Xl(t,L,G,or,Yl),b(L,G,C+1);let et=v-I;if(et>bM)throw new Error("MeshBVH: Cannot store relative child node offset greater than 32 bits.");x[U+6]=et;let X=E-G;Xl(t,H,X,or,Yl),b(H,X,C+1)}}function tm(i,t){let e=i.getRootRanges(t.range),n=e[0],s=e[e.length-1],r={offset:n.offset,count:s.offset+s.count-n.offset},o=new Float32Array(6*r.count);o.offset=r.offset,i.computePrimitiveBounds(r.offset,r.count,o),i._roots=e.map(l=>wM(i,o,l.offset,l.count,t,r))}var Xi=class{constructor(t){this._getNewPrimitive=t,this._primitives=[]}getPrimitive(){let t=this._primitives;return t.length===0?this._getNewPrimitive():t.pop()}releasePrimitive(t){this._primitives.push(t)}};var _h=class{constructor(){this.float32Array=null,this.uint16Array=null,this.uint32Array=null;let t=[],e=null;this.setBuffer=n=>{e&&t.push(e),e=n,this.float32Array=new Float32Array(n),this.uint16Array=new Uint16Array(n),this.uint32Array=new Uint32Array(n)},this.clearBuffer=()=>{e=null,this.float32Array=null,this.uint16Array=null,this.uint32Array=null,t.length!==0&&this.setBuffer(t.pop())}}},Ht=new _h;var qi,lr,ar=[],$l=new Xi(()=>new _e);function em(i,t,e,n,s,r){qi=$l.getPrimitive(),lr=$l.getPrimitive(),ar.push(qi,lr),Ht.setBuffer(i._roots[t]);let o=yh(0,i.geometry,e,n,s,r);Ht.clearBuffer(),$l.releasePrimitive(qi),$l.releasePrimitive(lr),ar.pop(),ar.pop();let l=ar.length;return l>0&&(lr=ar[l-1],qi=ar[l-2]),o}function yh(i,t,e,n,s=null,r=0,o=0){let{float32Array:l,uint16Array:a,uint32Array:c}=Ht,u=i*2;if(Jt(u,a)){let f=ie(i,c),d=oe(u,a);return ue(i,l,qi),n(f,d,!1,o,r+i/8,qi)}else{let E=function(I){let{uint16Array:U,uint32Array:P}=Ht,B=I*2;for(;!Jt(B,U);)I=te(I),B=I*2;return ie(I,P)},C=function(I){let{uint16Array:U,uint32Array:P}=Ht,B=I*2;for(;!Jt(B,U);)I=ee(I,P),B=I*2;return ie(I,P)+oe(B,U)},f=te(i),d=ee(i,c),g=f,y=d,p,m,x,M;if(s&&(x=qi,M=lr,ue(g,l,x),ue(y,l,M),p=s(x),m=s(M),m<p)){g=d,y=f;let I=p;p=m,m=I,x=M}x||(x=qi,ue(g,l,x));let v=Jt(g*2,a),S=e(x,v,p,o+1,r+g/8),A;if(S===2){let I=E(g),P=C(g)-I;A=n(I,P,!0,o+1,r+g/8,x)}else A=S&&yh(g,t,e,n,s,r,o+1);if(A)return!0;M=lr,ue(y,l,M);let _=Jt(y*2,a),b=e(M,_,m,o+1,r+y/8),L;if(b===2){let I=E(y),P=C(y)-I;L=n(I,P,!0,o+1,r+y/8,M)}else L=b&&yh(y,t,e,n,s,r,o+1);return!!L}}var fo=new Ht.constructor,Zl=new Ht.constructor,Yi=new Xi(()=>new _e),cr=new _e,ur=new _e,Mh=new _e,Sh=new _e,bh=!1;function nm(i,t,e,n){if(bh)throw new Error("MeshBVH: Recursive calls to bvhcast not supported.");bh=!0;let s=i._roots,r=t._roots,o,l=0,a=0,c=new zt().copy(e).invert();for(let u=0,h=s.length;u<h;u++){fo.setBuffer(s[u]),a=0;let f=Yi.getPrimitive();ue(0,fo.float32Array,f),f.applyMatrix4(c);for(let d=0,g=r.length;d<g&&(Zl.setBuffer(r[d]),o=qn(0,0,e,c,n,l,a,0,0,f),Zl.clearBuffer(),a+=r[d].byteLength/32,!o);d++);if(Yi.releasePrimitive(f),fo.clearBuffer(),l+=s[u].byteLength/32,o)break}return bh=!1,o}function qn(i,t,e,n,s,r=0,o=0,l=0,a=0,c=null,u=!1){let h,f;u?(h=Zl,f=fo):(h=fo,f=Zl);let d=h.float32Array,g=h.uint32Array,y=h.uint16Array,p=f.float32Array,m=f.uint32Array,x=f.uint16Array,M=i*2,v=t*2,S=Jt(M,y),A=Jt(v,x),_=!1;if(A&&S)u?_=s(ie(t,m),oe(t*2,x),ie(i,g),oe(i*2,y),a,o+t/8,l,r+i/8):_=s(ie(i,g),oe(i*2,y),ie(t,m),oe(t*2,x),l,r+i/8,a,o+t/8);else if(A){let b=Yi.getPrimitive();ue(t,p,b),b.applyMatrix4(e);let L=te(i),E=ee(i,g);ue(L,d,cr),ue(E,d,ur);let C=b.intersectsBox(cr),I=b.intersectsBox(ur);_=C&&qn(t,L,n,e,s,o,r,a,l+1,b,!u)||I&&qn(t,E,n,e,s,o,r,a,l+1,b,!u),Yi.releasePrimitive(b)}else{let b=te(t),L=ee(t,m);ue(b,p,Mh),ue(L,p,Sh);let E=c.intersectsBox(Mh),C=c.intersectsBox(Sh);if(E&&C)_=qn(i,b,e,n,s,r,o,l,a+1,c,u)||qn(i,L,e,n,s,r,o,l,a+1,c,u);else if(E)if(S)_=qn(i,b,e,n,s,r,o,l,a+1,c,u);else{let I=Yi.getPrimitive();I.copy(Mh).applyMatrix4(e);let U=te(i),P=ee(i,g);ue(U,d,cr),ue(P,d,ur);let B=I.intersectsBox(cr),H=I.intersectsBox(ur);_=B&&qn(b,U,n,e,s,o,r,a,l+1,I,!u)||H&&qn(b,P,n,e,s,o,r,a,l+1,I,!u),Yi.releasePrimitive(I)}else if(C)if(S)_=qn(i,L,e,n,s,r,o,l,a+1,c,u);else{let I=Yi.getPrimitive();I.copy(Sh).applyMatrix4(e);let U=te(i),P=ee(i,g);ue(U,d,cr),ue(P,d,ur);let B=I.intersectsBox(cr),H=I.intersectsBox(ur);_=B&&qn(L,U,n,e,s,o,r,a,l+1,I,!u)||H&&qn(L,P,n,e,s,o,r,a,l+1,I,!u),Yi.releasePrimitive(I)}}return _}var Jl=new class{constructor(){let i=null,t=null,e=null,n=!1;this.root=null,this.buffer=null,this.uint32Array=null,this.uint16Array=null,this.setBVH=(r,o)=>{if(n)throw new Error("BVHTraversalHelper: cannot call setBVH during an active traversal.");this.root=o,this.buffer=i=r._roots[o],this.uint16Array=e=new Uint16Array(i),this.uint32Array=t=new Uint32Array(i)},this.reset=()=>{this.root=null,this.buffer=i=null,this.uint16Array=e=null,this.uint32Array=t=null},this.getRangeStart=r=>{let o=r*2;for(;!Jt(o,e);)r=te(r),o=r*2;return ie(r,t)},this.getRangeEnd=r=>{let o=r*2;for(;!Jt(o,e);)r=ee(r,t),o=r*2;return ie(r,t)+oe(o,e)};let s=(r,o,l)=>{let a=o*2,c=Jt(a,e);if(!r(l,c,o)&&!c){let h=te(o),f=ee(o,t);s(r,h,l+1),s(r,f,l+1)}};this.traverseBuffer=r=>{if(n)throw new Error("BVHTraversalHelper: cannot start a traversal during an active traversal.");n=!0;try{s(r,0,0)}finally{n=!1}},this.traverse=r=>{this.traverseBuffer((o,l,a)=>{if(l){let c=a*2,u=t[a+6],h=e[c+14];return r(o,l,new Float32Array(i,a*4,6),u,h)}else{let c=sr(a,t);return r(o,l,new Float32Array(i,a*4,6),c)}})}}};var im=new _e,hr=new Float32Array(6),Kl=class{constructor(){this._roots=null,this.primitiveBuffer=null,this.primitiveBufferStride=null}init(t){t={...Hl,...t},"maxLeafSize"in t&&(console.warn('BVH: "maxLeafSize" option has been deprecated. Use "targetLeafSize", instead.'),t={...t,targetLeafSize:t.maxLeafSize}),tm(this,t)}getRootRanges(){throw new Error("BVH: getRootRanges() not implemented")}writePrimitiveBounds(){throw new Error("BVH: writePrimitiveBounds() not implemented")}writePrimitiveRangeBounds(t,e,n,s){let r=1/0,o=1/0,l=1/0,a=-1/0,c=-1/0,u=-1/0;for(let h=t,f=t+e;h<f;h++){this.writePrimitiveBounds(h,hr,0);let[d,g,y,p,m,x]=hr;d<r&&(r=d),p>a&&(a=p),g<o&&(o=g),m>c&&(c=m),y<l&&(l=y),x>u&&(u=x)}return n[s+0]=r,n[s+1]=o,n[s+2]=l,n[s+3]=a,n[s+4]=c,n[s+5]=u,n}computePrimitiveBounds(t,e,n){let s=n.offset||0;for(let r=t,o=t+e;r<o;r++){this.writePrimitiveBounds(r,hr,0);let[l,a,c,u,h,f]=hr,d=(l+u)/2,g=(a+h)/2,y=(c+f)/2,p=(u-l)/2,m=(h-a)/2,x=(f-c)/2,M=(r-s)*6;n[M+0]=d,n[M+1]=p+(Math.abs(d)+p)*ir,n[M+2]=g,n[M+3]=m+(Math.abs(g)+m)*ir,n[M+4]=y,n[M+5]=x+(Math.abs(y)+x)*ir}return n}shiftPrimitiveOffsets(t){let e=this._indirectBuffer;if(e)for(let n=0,s=e.length;n<s;n++)e[n]+=t;else{let n=this._roots;for(let s=0;s<n.length;s++){let r=n[s],o=new Uint32Array(r),l=new Uint16Array(r),a=r.byteLength/32;for(let c=0;c<a;c++){let u=8*c,h=2*u;Jt(h,l)&&(o[u+6]+=t)}}}}traverse(t,e=0){Jl.setBVH(this,e),Jl.traverse(t),Jl.reset()}refit(){let t=this._roots;for(let e=0,n=t.length;e<n;e++){let s=t[e],r=new Uint32Array(s),o=new Uint16Array(s),l=new Float32Array(s),a=s.byteLength/32;for(let c=a-1;c>=0;c--){let u=c*8,h=u*2;if(Jt(h,o)){let d=ie(u,r),g=oe(h,o);this.writePrimitiveRangeBounds(d,g,hr,0),l.set(hr,u)}else{let d=te(u),g=ee(u,r);for(let y=0;y<3;y++){let p=l[d+y],m=l[d+y+3],x=l[g+y],M=l[g+y+3];l[u+y]=p<x?p:x,l[u+y+3]=m>M?m:M}}}}}getBoundingBox(t){return t.makeEmpty(),this._roots.forEach(n=>{ue(0,new Float32Array(n),im),t.union(im)}),t}shapecast(t){let{boundsTraverseOrder:e,intersectsBounds:n,intersectsRange:s,intersectsPrimitive:r,scratchPrimitive:o,iterate:l}=t;if(s&&r){let h=s;s=(f,d,g,y,p)=>h(f,d,g,y,p)?!0:l(f,d,this,r,g,y,o)}else s||(r?s=(h,f,d,g)=>l(h,f,this,r,d,g,o):s=(h,f,d)=>d);let a=!1,c=0,u=this._roots;for(let h=0,f=u.length;h<f;h++){let d=u[h];if(a=em(this,h,n,s,e,c),a)break;c+=d.byteLength/32}return a}bvhcast(t,e,n){let{intersectsRanges:s}=n;return nm(this,t,e,s)}};function sm(){return typeof SharedArrayBuffer<"u"}function wh(i){return i.index?i.index.count:i.attributes.position.count}function $i(i){return wh(i)/3}function TM(i,t=ArrayBuffer){return i>65535?new Uint32Array(new t(4*i)):new Uint16Array(new t(2*i))}function rm(i,t){if(!i.index){let e=i.attributes.position.count,n=t.useSharedArrayBuffer?SharedArrayBuffer:ArrayBuffer,s=TM(e,n);i.setIndex(new Ae(s,1));for(let r=0;r<e;r++)s[r]=r}}function EM(i,t,e){let n=wh(i)/e,s=t||i.drawRange,r=s.start/e,o=(s.start+s.count)/e,l=Math.max(0,r),a=Math.min(n,o)-l;return{offset:Math.floor(l),count:Math.floor(a)}}function RM(i,t){return i.groups.map(e=>({offset:e.start/t,count:e.count/t}))}function Ah(i,t,e){let n=EM(i,t,e),s=RM(i,e);if(!s.length)return[n];let r=[],o=n.offset,l=n.offset+n.count,a=wh(i)/e,c=[];for(let f of s){let{offset:d,count:g}=f,y=d,p=isFinite(g)?g:a-d,m=d+p;y<l&&m>o&&(c.push({pos:Math.max(o,y),isStart:!0}),c.push({pos:Math.min(l,m),isStart:!1}))}c.sort((f,d)=>f.pos!==d.pos?f.pos-d.pos:f.type==="end"?-1:1);let u=0,h=null;for(let f of c){let d=f.pos;u!==0&&d!==h&&r.push({offset:h,count:d-h}),u+=f.isStart?1:-1,h=d}return r}function CM(i,t){let e=i[i.length-1],n=e.offset+e.count>2**16,s=i.reduce((c,u)=>c+u.count,0),r=n?4:2,o=t?new SharedArrayBuffer(s*r):new ArrayBuffer(s*r),l=n?new Uint32Array(o):new Uint16Array(o),a=0;for(let c=0;c<i.length;c++){let{offset:u,count:h}=i[c];for(let f=0;f<h;f++)l[a+f]=u+f;a+=h}return l}var Ql=class extends Kl{get indirect(){return!!this._indirectBuffer}get primitiveStride(){return null}get primitiveBufferStride(){return this.indirect?1:this.primitiveStride}set primitiveBufferStride(t){}get primitiveBuffer(){return this.indirect?this._indirectBuffer:this.geometry.index.array}set primitiveBuffer(t){}constructor(t,e={}){if(t.isBufferGeometry){if(t.index&&t.index.isInterleavedBufferAttribute)throw new Error("BVH: InterleavedBufferAttribute is not supported for the index attribute.")}else throw new Error("BVH: Only BufferGeometries are supported.");if(e.useSharedArrayBuffer&&!sm())throw new Error("BVH: SharedArrayBuffer is not available.");super(),this.geometry=t,this.resolvePrimitiveIndex=e.indirect?n=>this._indirectBuffer[n]:n=>n,this.primitiveBuffer=null,this.primitiveBufferStride=null,this._indirectBuffer=null,e={...Hl,...e},e[uo]||this.init(e)}init(t){let{geometry:e,primitiveStride:n}=this;if(t.indirect){let s=Ah(e,t.range,n),r=CM(s,t.useSharedArrayBuffer);this._indirectBuffer=r}else rm(e,t);super.init(t),!e.boundingBox&&t.setBoundingBox&&(e.boundingBox=this.getBoundingBox(new _e))}getRootRanges(t){return this.indirect?[{offset:0,count:this._indirectBuffer.length}]:Ah(this.geometry,t,this.primitiveStride)}raycastObject3D(){throw new Error("BVH: raycastObject3D() not implemented")}};var bn=class{constructor(){this.min=1/0,this.max=-1/0}setFromPointsField(t,e){let n=1/0,s=-1/0;for(let r=0,o=t.length;r<o;r++){let a=t[r][e];n=a<n?a:n,s=a>s?a:s}this.min=n,this.max=s}setFromPoints(t,e){let n=1/0,s=-1/0;for(let r=0,o=e.length;r<o;r++){let l=e[r],a=t.dot(l);n=a<n?a:n,s=a>s?a:s}this.min=n,this.max=s}isSeparated(t){return this.min>t.max||t.min>this.max}};bn.prototype.setFromBox=(function(){let i=new N;return function(e,n){let s=n.min,r=n.max,o=1/0,l=-1/0;for(let a=0;a<=1;a++)for(let c=0;c<=1;c++)for(let u=0;u<=1;u++){i.x=s.x*a+r.x*(1-a),i.y=s.y*c+r.y*(1-c),i.z=s.z*u+r.z*(1-u);let h=e.dot(i);o=Math.min(h,o),l=Math.max(h,l)}this.min=o,this.max=l}})();var PM=(function(){let i=new N,t=new N,e=new N;return function(s,r,o){let l=s.start,a=i,c=r.start,u=t;e.subVectors(l,c),i.subVectors(s.end,s.start),t.subVectors(r.end,r.start);let h=e.dot(u),f=u.dot(a),d=u.dot(u),g=e.dot(a),p=a.dot(a)*d-f*f,m,x;p!==0?m=(h*f-g*d)/p:m=0,x=(h+m*f)/d,o.x=m,o.y=x}})(),po=(function(){let i=new Et,t=new N,e=new N;return function(s,r,o,l){PM(s,r,i);let a=i.x,c=i.y;if(a>=0&&a<=1&&c>=0&&c<=1){s.at(a,o),r.at(c,l);return}else if(a>=0&&a<=1){c<0?r.at(0,l):r.at(1,l),s.closestPointToPoint(l,!0,o);return}else if(c>=0&&c<=1){a<0?s.at(0,o):s.at(1,o),r.closestPointToPoint(o,!0,l);return}else{let u;a<0?u=s.start:u=s.end;let h;c<0?h=r.start:h=r.end;let f=t,d=e;if(s.closestPointToPoint(h,!0,t),r.closestPointToPoint(u,!0,e),f.distanceToSquared(h)<=d.distanceToSquared(u)){o.copy(f),l.copy(h);return}else{o.copy(u),l.copy(d);return}}}})(),om=(function(){let i=new N,t=new N,e=new sn,n=new an;return function(r,o){let{radius:l,center:a}=r,{a:c,b:u,c:h}=o;if(n.start=c,n.end=u,n.closestPointToPoint(a,!0,i).distanceTo(a)<=l||(n.start=c,n.end=h,n.closestPointToPoint(a,!0,i).distanceTo(a)<=l)||(n.start=u,n.end=h,n.closestPointToPoint(a,!0,i).distanceTo(a)<=l))return!0;let y=o.getPlane(e);if(Math.abs(y.distanceToPoint(a))<=l){let m=y.projectPoint(a,t);if(o.containsPoint(m))return!0}return!1}})();var IM=["x","y","z"],wi=1e-15,am=wi*wi;function Ln(i){return Math.abs(i)<wi}var Ye=class extends ke{constructor(...t){super(...t),this.isExtendedTriangle=!0,this.satAxes=new Array(4).fill().map(()=>new N),this.satBounds=new Array(4).fill().map(()=>new bn),this.points=[this.a,this.b,this.c],this.plane=new sn,this.isDegenerateIntoSegment=!1,this.isDegenerateIntoPoint=!1,this.degenerateSegment=new an,this.needsUpdate=!0}intersectsSphere(t){return om(t,this)}update(){let t=this.a,e=this.b,n=this.c,s=this.points,r=this.satAxes,o=this.satBounds,l=r[0],a=o[0];this.getNormal(l),a.setFromPoints(l,s);let c=r[1],u=o[1];c.subVectors(t,e),u.setFromPoints(c,s);let h=r[2],f=o[2];h.subVectors(e,n),f.setFromPoints(h,s);let d=r[3],g=o[3];d.subVectors(n,t),g.setFromPoints(d,s);let y=c.length(),p=h.length(),m=d.length();this.isDegenerateIntoPoint=!1,this.isDegenerateIntoSegment=!1,y<wi?p<wi||m<wi?this.isDegenerateIntoPoint=!0:(this.isDegenerateIntoSegment=!0,this.degenerateSegment.start.copy(t),this.degenerateSegment.end.copy(n)):p<wi?m<wi?this.isDegenerateIntoPoint=!0:(this.isDegenerateIntoSegment=!0,this.degenerateSegment.start.copy(e),this.degenerateSegment.end.copy(t)):m<wi&&(this.isDegenerateIntoSegment=!0,this.degenerateSegment.start.copy(n),this.degenerateSegment.end.copy(e)),this.plane.setFromNormalAndCoplanarPoint(l,t),this.needsUpdate=!1}};Ye.prototype.closestPointToSegment=(function(){let i=new N,t=new N,e=new an;return function(s,r=null,o=null){this.needsUpdate&&this.update();let{start:l,end:a}=s,c=this.points,u,h=1/0,f=this.plane.distanceToPoint(l),d=this.plane.distanceToPoint(a);if(f*d<0&&this.plane.intersectLine(s,i)!==null&&this.containsPoint(i))return r&&r.copy(i),o&&o.copy(i),0;for(let g=0;g<3;g++){let y=(g+1)%3;e.start.copy(c[g]),e.end.copy(c[y]),po(e,s,i,t),u=i.distanceToSquared(t),u<h&&(h=u,r&&r.copy(i),o&&o.copy(t))}return this.closestPointToPoint(l,i),u=l.distanceToSquared(i),u<h&&(h=u,r&&r.copy(i),o&&o.copy(l)),this.closestPointToPoint(a,i),u=a.distanceToSquared(i),u<h&&(h=u,r&&r.copy(i),o&&o.copy(a)),Math.sqrt(h)}})();Ye.prototype.intersectsTriangle=(function(){let i=new Ye,t=new bn,e=new bn,n=new N,s=new N,r=new N,o=new N,l=new an,a=new an,c=new N,u=new Et,h=new Et;function f(M,v,S,A){let _=n;!M.isDegenerateIntoPoint&&!M.isDegenerateIntoSegment?_.copy(M.plane.normal):_.copy(v.plane.normal);let b=M.satBounds,L=M.satAxes;for(let I=1;I<4;I++){let U=b[I],P=L[I];if(t.setFromPoints(P,v.points),U.isSeparated(t)||(o.copy(_).cross(P),t.setFromPoints(o,M.points),e.setFromPoints(o,v.points),t.isSeparated(e)))return!1}let E=v.satBounds,C=v.satAxes;for(let I=1;I<4;I++){let U=E[I],P=C[I];if(t.setFromPoints(P,M.points),U.isSeparated(t)||(o.crossVectors(_,P),t.setFromPoints(o,M.points),e.setFromPoints(o,v.points),t.isSeparated(e)))return!1}return S&&(A||console.warn("ExtendedTriangle.intersectsTriangle: Triangles are coplanar which does not support an output edge. Setting edge to 0, 0, 0."),S.start.set(0,0,0),S.end.set(0,0,0)),!0}function d(M,v,S,A,_,b,L,E,C,I,U){let P=L/(L-E);I.x=A+(_-A)*P,U.start.subVectors(v,M).multiplyScalar(P).add(M),P=L/(L-C),I.y=A+(b-A)*P,U.end.subVectors(S,M).multiplyScalar(P).add(M)}function g(M,v,S,A,_,b,L,E,C,I,U){if(_>0)d(M.c,M.a,M.b,A,v,S,C,L,E,I,U);else if(b>0)d(M.b,M.a,M.c,S,v,A,E,L,C,I,U);else if(E*C>0||L!=0)d(M.a,M.b,M.c,v,S,A,L,E,C,I,U);else if(E!=0)d(M.b,M.a,M.c,S,v,A,E,L,C,I,U);else if(C!=0)d(M.c,M.a,M.b,A,v,S,C,L,E,I,U);else return!0;return!1}function y(M,v,S,A){let _=v.degenerateSegment,b=M.plane.distanceToPoint(_.start),L=M.plane.distanceToPoint(_.end);return Ln(b)?Ln(L)?f(M,v,S,A):(S&&(S.start.copy(_.start),S.end.copy(_.start)),M.containsPoint(_.start)):Ln(L)?(S&&(S.start.copy(_.end),S.end.copy(_.end)),M.containsPoint(_.end)):M.plane.intersectLine(_,n)!=null?(S&&(S.start.copy(n),S.end.copy(n)),M.containsPoint(n)):!1}function p(M,v,S){let A=v.a;return Ln(M.plane.distanceToPoint(A))&&M.containsPoint(A)?(S&&(S.start.copy(A),S.end.copy(A)),!0):!1}function m(M,v,S){let A=M.degenerateSegment,_=v.a;return A.closestPointToPoint(_,!0,n),_.distanceToSquared(n)<am?(S&&(S.start.copy(_),S.end.copy(_)),!0):!1}function x(M,v,S,A){if(M.isDegenerateIntoSegment)if(v.isDegenerateIntoSegment){let _=M.degenerateSegment,b=v.degenerateSegment,L=s,E=r;_.delta(L),b.delta(E);let C=n.subVectors(b.start,_.start),I=L.x*E.y-L.y*E.x;if(Ln(I))return!1;let U=(C.x*E.y-C.y*E.x)/I,P=-(L.x*C.y-L.y*C.x)/I;if(U<0||U>1||P<0||P>1)return!1;let B=_.start.z+L.z*U,H=b.start.z+E.z*P;return Ln(B-H)?(S&&(S.start.copy(_.start).addScaledVector(L,U),S.end.copy(_.start).addScaledVector(L,U)),!0):!1}else return v.isDegenerateIntoPoint?m(M,v,S):y(v,M,S,A);else{if(M.isDegenerateIntoPoint)return v.isDegenerateIntoPoint?v.a.distanceToSquared(M.a)<am?(S&&(S.start.copy(M.a),S.end.copy(M.a)),!0):!1:v.isDegenerateIntoSegment?m(v,M,S):p(v,M,S);if(v.isDegenerateIntoPoint)return p(M,v,S);if(v.isDegenerateIntoSegment)return y(M,v,S,A)}}return function(v,S=null,A=!1){this.needsUpdate&&this.update(),v.isExtendedTriangle?v.needsUpdate&&v.update():(i.copy(v),i.update(),v=i);let _=x(this,v,S,A);if(_!==void 0)return _;let b=this.plane,L=v.plane,E=L.distanceToPoint(this.a),C=L.distanceToPoint(this.b),I=L.distanceToPoint(this.c);Ln(E)&&(E=0),Ln(C)&&(C=0),Ln(I)&&(I=0);let U=E*C,P=E*I;if(U>0&&P>0)return!1;let B=b.distanceToPoint(v.a),H=b.distanceToPoint(v.b),G=b.distanceToPoint(v.c);Ln(B)&&(B=0),Ln(H)&&(H=0),Ln(G)&&(G=0);let et=B*H,X=B*G;if(et>0&&X>0)return!1;s.copy(b.normal),r.copy(L.normal);let j=s.cross(r),tt=0,yt=Math.abs(j.x),Nt=Math.abs(j.y);Nt>yt&&(yt=Nt,tt=1),Math.abs(j.z)>yt&&(tt=2);let ut=IM[tt],_t=this.a[ut],Tt=this.b[ut],pt=this.c[ut],Ut=v.a[ut],Se=v.b[ut],Ct=v.c[ut];if(g(this,_t,Tt,pt,U,P,E,C,I,u,l))return f(this,v,S,A);if(g(v,Ut,Se,Ct,et,X,B,H,G,h,a))return f(this,v,S,A);if(u.y<u.x){let Kt=u.y;u.y=u.x,u.x=Kt,c.copy(l.start),l.start.copy(l.end),l.end.copy(c)}if(h.y<h.x){let Kt=h.y;h.y=h.x,h.x=Kt,c.copy(a.start),a.start.copy(a.end),a.end.copy(c)}return u.y<h.x||h.y<u.x?!1:(S&&(h.x>u.x?S.start.copy(a.start):S.start.copy(l.start),h.y<u.y?S.end.copy(a.end):S.end.copy(l.end)),!0)}})();Ye.prototype.distanceToPoint=(function(){let i=new N;return function(e){return this.closestPointToPoint(e,i),e.distanceTo(i)}})();Ye.prototype.distanceToTriangle=(function(){let i=new N,t=new N,e=["a","b","c"],n=new an,s=new an;return function(o,l=null,a=null){let c=l||a?n:null;if(this.intersectsTriangle(o,c,!0))return(l||a)&&(l&&c.getCenter(l),a&&c.getCenter(a)),0;let u=1/0;for(let h=0;h<3;h++){let f,d=e[h],g=o[d];this.closestPointToPoint(g,i),f=g.distanceToSquared(i),f<u&&(u=f,l&&l.copy(i),a&&a.copy(g));let y=this[d];o.closestPointToPoint(y,i),f=y.distanceToSquared(i),f<u&&(u=f,l&&l.copy(y),a&&a.copy(i))}for(let h=0;h<3;h++){let f=e[h],d=e[(h+1)%3];n.set(this[f],this[d]);for(let g=0;g<3;g++){let y=e[g],p=e[(g+1)%3];s.set(o[y],o[p]),po(n,s,i,t);let m=i.distanceToSquared(t);m<u&&(u=m,l&&l.copy(i),a&&a.copy(t))}}return Math.sqrt(u)}})();var we=class{constructor(t,e,n){this.isOrientedBox=!0,this.min=new N,this.max=new N,this.matrix=new zt,this.invMatrix=new zt,this.points=new Array(8).fill().map(()=>new N),this.satAxes=new Array(3).fill().map(()=>new N),this.satBounds=new Array(3).fill().map(()=>new bn),this.alignedSatBounds=new Array(3).fill().map(()=>new bn),this.needsUpdate=!1,t&&this.min.copy(t),e&&this.max.copy(e),n&&this.matrix.copy(n)}set(t,e,n){this.min.copy(t),this.max.copy(e),this.matrix.copy(n),this.needsUpdate=!0}copy(t){this.min.copy(t.min),this.max.copy(t.max),this.matrix.copy(t.matrix),this.needsUpdate=!0}};we.prototype.update=(function(){return function(){let t=this.matrix,e=this.min,n=this.max,s=this.points;for(let c=0;c<=1;c++)for(let u=0;u<=1;u++)for(let h=0;h<=1;h++){let f=1*c|2*u|4*h,d=s[f];d.x=c?n.x:e.x,d.y=u?n.y:e.y,d.z=h?n.z:e.z,d.applyMatrix4(t)}let r=this.satBounds,o=this.satAxes,l=s[0];for(let c=0;c<3;c++){let u=o[c],h=r[c],f=1<<c,d=s[f];u.subVectors(l,d),h.setFromPoints(u,s)}let a=this.alignedSatBounds;a[0].setFromPointsField(s,"x"),a[1].setFromPointsField(s,"y"),a[2].setFromPointsField(s,"z"),this.invMatrix.copy(this.matrix).invert(),this.needsUpdate=!1}})();we.prototype.intersectsBox=(function(){let i=new bn;return function(e){this.needsUpdate&&this.update();let n=e.min,s=e.max,r=this.satBounds,o=this.satAxes,l=this.alignedSatBounds;if(i.min=n.x,i.max=s.x,l[0].isSeparated(i)||(i.min=n.y,i.max=s.y,l[1].isSeparated(i))||(i.min=n.z,i.max=s.z,l[2].isSeparated(i)))return!1;for(let a=0;a<3;a++){let c=o[a],u=r[a];if(i.setFromBox(c,e),u.isSeparated(i))return!1}return!0}})();we.prototype.intersectsTriangle=(function(){let i=new Ye,t=new Array(3),e=new bn,n=new bn,s=new N;return function(o){this.needsUpdate&&this.update(),o.isExtendedTriangle?o.needsUpdate&&o.update():(i.copy(o),i.update(),o=i);let l=this.satBounds,a=this.satAxes;t[0]=o.a,t[1]=o.b,t[2]=o.c;for(let f=0;f<3;f++){let d=l[f],g=a[f];if(e.setFromPoints(g,t),d.isSeparated(e))return!1}let c=o.satBounds,u=o.satAxes,h=this.points;for(let f=0;f<3;f++){let d=c[f],g=u[f];if(e.setFromPoints(g,h),d.isSeparated(e))return!1}for(let f=0;f<3;f++){let d=a[f];for(let g=0;g<4;g++){let y=u[g];if(s.crossVectors(d,y),e.setFromPoints(s,t),n.setFromPoints(s,h),e.isSeparated(n))return!1}}return!0}})();we.prototype.closestPointToPoint=(function(){return function(t,e){return this.needsUpdate&&this.update(),e.copy(t).applyMatrix4(this.invMatrix).clamp(this.min,this.max).applyMatrix4(this.matrix),e}})();we.prototype.distanceToPoint=(function(){let i=new N;return function(e){return this.closestPointToPoint(e,i),e.distanceTo(i)}})();we.prototype.distanceToBox=(function(){let i=["x","y","z"],t=new Array(12).fill().map(()=>new an),e=new Array(12).fill().map(()=>new an),n=new N,s=new N;return function(o,l=0,a=null,c=null){if(this.needsUpdate&&this.update(),this.intersectsBox(o))return(a||c)&&(o.getCenter(s),this.closestPointToPoint(s,n),o.closestPointToPoint(n,s),a&&a.copy(n),c&&c.copy(s)),0;let u=l*l,h=o.min,f=o.max,d=this.points,g=1/0;for(let p=0;p<8;p++){let m=d[p];s.copy(m).clamp(h,f);let x=m.distanceToSquared(s);if(x<g&&(g=x,a&&a.copy(m),c&&c.copy(s),x<u))return Math.sqrt(x)}let y=0;for(let p=0;p<3;p++)for(let m=0;m<=1;m++)for(let x=0;x<=1;x++){let M=(p+1)%3,v=(p+2)%3,S=m<<M|x<<v,A=1<<p|m<<M|x<<v,_=d[S],b=d[A];t[y].set(_,b);let E=i[p],C=i[M],I=i[v],U=e[y],P=U.start,B=U.end;P[E]=h[E],P[C]=m?h[C]:f[C],P[I]=x?h[I]:f[I],B[E]=f[E],B[C]=m?h[C]:f[C],B[I]=x?h[I]:f[I],y++}for(let p=0;p<=1;p++)for(let m=0;m<=1;m++)for(let x=0;x<=1;x++){s.x=p?f.x:h.x,s.y=m?f.y:h.y,s.z=x?f.z:h.z,this.closestPointToPoint(s,n);let M=s.distanceToSquared(n);if(M<g&&(g=M,a&&a.copy(n),c&&c.copy(s),M<u))return Math.sqrt(M)}for(let p=0;p<12;p++){let m=t[p];for(let x=0;x<12;x++){let M=e[x];po(m,M,n,s);let v=n.distanceToSquared(s);if(v<g&&(g=v,a&&a.copy(n),c&&c.copy(s),v<u))return Math.sqrt(v)}}return Math.sqrt(g)}})();var Th=class extends Xi{constructor(){super(()=>new Ye)}},cn=new Th;var mo=new N,Eh=new N;function lm(i,t,e={},n=0,s=1/0){let r=n*n,o=s*s,l=1/0,a=null;if(i.shapecast({boundsTraverseOrder:u=>(mo.copy(t).clamp(u.min,u.max),mo.distanceToSquared(t)),intersectsBounds:(u,h,f)=>f<l&&f<o,intersectsTriangle:(u,h)=>{u.closestPointToPoint(t,mo);let f=t.distanceToSquared(mo);return f<l&&(Eh.copy(mo),l=f,a=h),f<r}}),l===1/0)return null;let c=Math.sqrt(l);return e.point?e.point.copy(Eh):e.point=Eh.clone(),e.distance=c,e.faceIndex=a,e}var jl=parseInt("187")>=169,LM=parseInt("187")<=161,gs=new N,xs=new N,_s=new N,tc=new Et,ec=new Et,nc=new Et,cm=new N,um=new N,hm=new N,go=new N;function NM(i,t,e,n,s,r,o,l){let a;if(r===qe?a=i.intersectTriangle(n,e,t,!0,s):a=i.intersectTriangle(t,e,n,r!==ye,s),a===null)return null;let c=i.origin.distanceTo(s);return c<o||c>l?null:{distance:c,point:s.clone()}}function fm(i,t,e,n,s,r,o,l,a,c,u){gs.fromBufferAttribute(t,r),xs.fromBufferAttribute(t,o),_s.fromBufferAttribute(t,l);let h=NM(i,gs,xs,_s,go,a,c,u);if(h){if(n){tc.fromBufferAttribute(n,r),ec.fromBufferAttribute(n,o),nc.fromBufferAttribute(n,l),h.uv=new Et;let d=ke.getInterpolation(go,gs,xs,_s,tc,ec,nc,h.uv);jl||(h.uv=d)}if(s){tc.fromBufferAttribute(s,r),ec.fromBufferAttribute(s,o),nc.fromBufferAttribute(s,l),h.uv1=new Et;let d=ke.getInterpolation(go,gs,xs,_s,tc,ec,nc,h.uv1);jl||(h.uv1=d),LM&&(h.uv2=h.uv1)}if(e){cm.fromBufferAttribute(e,r),um.fromBufferAttribute(e,o),hm.fromBufferAttribute(e,l),h.normal=new N;let d=ke.getInterpolation(go,gs,xs,_s,cm,um,hm,h.normal);h.normal.dot(i.direction)>0&&h.normal.multiplyScalar(-1),jl||(h.normal=d)}let f={a:r,b:o,c:l,normal:new N,materialIndex:0};if(ke.getNormal(gs,xs,_s,f.normal),h.face=f,h.faceIndex=r,jl){let d=new N;ke.getBarycoord(go,gs,xs,_s,d),h.barycoord=d}}return h}function dm(i){return i&&i.isMaterial?i.side:i}function fr(i,t,e,n,s,r,o){let l=n*3,a=l+0,c=l+1,u=l+2,{index:h,groups:f}=i;i.index&&(a=h.getX(a),c=h.getX(c),u=h.getX(u));let{position:d,normal:g,uv:y,uv1:p}=i.attributes;if(Array.isArray(t)){let m=n*3;for(let x=0,M=f.length;x<M;x++){let{start:v,count:S,materialIndex:A}=f[x];if(m>=v&&m<v+S){let _=dm(t[A]),b=fm(e,d,g,y,p,a,c,u,_,r,o);if(b)if(b.faceIndex=n,b.face.materialIndex=A,s)s.push(b);else return b}}}else{let m=dm(t),x=fm(e,d,g,y,p,a,c,u,m,r,o);if(x)if(x.faceIndex=n,x.face.materialIndex=0,s)s.push(x);else return x}return null}function he(i,t,e,n){let s=i.a,r=i.b,o=i.c,l=t,a=t+1,c=t+2;e&&(l=e.getX(l),a=e.getX(a),c=e.getX(c)),s.x=n.getX(l),s.y=n.getY(l),s.z=n.getZ(l),r.x=n.getX(a),r.y=n.getY(a),r.z=n.getZ(a),o.x=n.getX(c),o.y=n.getY(c),o.z=n.getZ(c)}function pm(i,t,e,n,s,r,o,l){let{geometry:a,_indirectBuffer:c}=i;for(let u=n,h=n+s;u<h;u++)fr(a,t,e,u,r,o,l)}function mm(i,t,e,n,s,r,o){let{geometry:l,_indirectBuffer:a}=i,c=1/0,u=null;for(let h=n,f=n+s;h<f;h++){let d;d=fr(l,t,e,h,null,r,o),d&&d.distance<c&&(u=d,c=d.distance)}return u}function gm(i,t,e,n,s,r,o){let{geometry:l}=e,{index:a}=l,c=l.attributes.position;for(let u=i,h=t+i;u<h;u++){let f;if(f=u,he(o,f*3,a,c),o.needsUpdate=!0,n(o,f,s,r))return!0}return!1}function xm(i,t=null){t&&Array.isArray(t)&&(t=new Set(t));let e=i.geometry,n=e.index?e.index.array:null,s=e.attributes.position,r,o,l,a,c=0,u=i._roots;for(let f=0,d=u.length;f<d;f++)r=u[f],o=new Uint32Array(r),l=new Uint16Array(r),a=new Float32Array(r),h(0,c),c+=r.byteLength;function h(f,d,g=!1){let y=f*2;if(Jt(y,l)){let p=ie(f,o),m=oe(y,l),x=1/0,M=1/0,v=1/0,S=-1/0,A=-1/0,_=-1/0;for(let b=3*p,L=3*(p+m);b<L;b++){let E=n[b],C=s.getX(E),I=s.getY(E),U=s.getZ(E);C<x&&(x=C),C>S&&(S=C),I<M&&(M=I),I>A&&(A=I),U<v&&(v=U),U>_&&(_=U)}return a[f+0]!==x||a[f+1]!==M||a[f+2]!==v||a[f+3]!==S||a[f+4]!==A||a[f+5]!==_?(a[f+0]=x,a[f+1]=M,a[f+2]=v,a[f+3]=S,a[f+4]=A,a[f+5]=_,!0):!1}else{let p=te(f),m=ee(f,o),x=g,M=!1,v=!1;if(t){if(!x){let E=p/8+d/32,C=m/8+d/32;M=t.has(E),v=t.has(C),x=!M&&!v}}else M=!0,v=!0;let S=x||M,A=x||v,_=!1;S&&(_=h(p,d,x));let b=!1;A&&(b=h(m,d,x));let L=_||b;if(L)for(let E=0;E<3;E++){let C=p+E,I=m+E,U=a[C],P=a[C+3],B=a[I],H=a[I+3];a[f+E]=U<B?U:B,a[f+E+3]=P>H?P:H}return L}}}function en(i,t,e,n,s){let r,o,l,a,c,u,h=1/e.direction.x,f=1/e.direction.y,d=1/e.direction.z,g=e.origin.x,y=e.origin.y,p=e.origin.z,m=t[i],x=t[i+3],M=t[i+1],v=t[i+3+1],S=t[i+2],A=t[i+3+2];return h>=0?(r=(m-g)*h,o=(x-g)*h):(r=(x-g)*h,o=(m-g)*h),f>=0?(l=(M-y)*f,a=(v-y)*f):(l=(v-y)*f,a=(M-y)*f),r>a||l>o||((l>r||isNaN(r))&&(r=l),(a<o||isNaN(o))&&(o=a),d>=0?(c=(S-p)*d,u=(A-p)*d):(c=(A-p)*d,u=(S-p)*d),r>u||c>o)?!1:((c>r||r!==r)&&(r=c),(u<o||o!==o)&&(o=u),r<=s&&o>=n)}function _m(i,t,e,n,s,r,o,l){let{geometry:a,_indirectBuffer:c}=i;for(let u=n,h=n+s;u<h;u++){let f=c?c[u]:u;fr(a,t,e,f,r,o,l)}}function ym(i,t,e,n,s,r,o){let{geometry:l,_indirectBuffer:a}=i,c=1/0,u=null;for(let h=n,f=n+s;h<f;h++){let d;d=fr(l,t,e,a?a[h]:h,null,r,o),d&&d.distance<c&&(u=d,c=d.distance)}return u}function vm(i,t,e,n,s,r,o){let{geometry:l}=e,{index:a}=l,c=l.attributes.position;for(let u=i,h=t+i;u<h;u++){let f;if(f=e.resolveTriangleIndex(u),he(o,f*3,a,c),o.needsUpdate=!0,n(o,f,s,r))return!0}return!1}function Mm(i,t,e,n,s,r,o){Ht.setBuffer(i._roots[t]),en(0,Ht.float32Array,n,r,o)&&Rh(0,i,e,n,s,r,o),Ht.clearBuffer()}function Rh(i,t,e,n,s,r,o){let{float32Array:l,uint16Array:a,uint32Array:c}=Ht,u=i*2;if(Jt(u,a)){let f=ie(i,c),d=oe(u,a);pm(t,e,n,f,d,s,r,o)}else{let f=te(i);en(f,l,n,r,o)&&Rh(f,t,e,n,s,r,o);let d=ee(i,c);en(d,l,n,r,o)&&Rh(d,t,e,n,s,r,o)}}var DM=["x","y","z"];function Sm(i,t,e,n,s,r){Ht.setBuffer(i._roots[t]);let o=null;return en(0,Ht.float32Array,n,s,r)&&(o=Ch(0,i,e,n,s,r)),Ht.clearBuffer(),o}function Ch(i,t,e,n,s,r){let{float32Array:o,uint16Array:l,uint32Array:a}=Ht,c=i*2;if(Jt(c,l)){let h=ie(i,a),f=oe(c,l);return mm(t,e,n,h,f,s,r)}else{let h=sr(i,a),f=DM[h],g=n.direction[f]>=0,y,p;g?(y=te(i),p=ee(i,a)):(y=ee(i,a),p=te(i));let x=en(y,o,n,s,r)?Ch(y,t,e,n,s,r):null;if(x){let S=x.point[f];if(g?S<=o[p+h]:S>=o[p+h+3])return x}let v=en(p,o,n,s,r)?Ch(p,t,e,n,s,r):null;return x&&v?x.distance<=v.distance?x:v:x||v||null}}var ic=new _e,dr=new Ye,pr=new Ye,xo=new zt,bm=new we,sc=new we;function wm(i,t,e,n){Ht.setBuffer(i._roots[t]);let s=Ph(0,i,e,n);return Ht.clearBuffer(),s}function Ph(i,t,e,n,s=null){let{float32Array:r,uint16Array:o,uint32Array:l}=Ht,a=i*2;if(s===null&&(e.boundingBox||e.computeBoundingBox(),bm.set(e.boundingBox.min,e.boundingBox.max,n),s=bm),Jt(a,o)){let u=t.geometry,h=u.index,f=u.attributes.position,d=e.index,g=e.attributes.position,y=ie(i,l),p=oe(a,o);if(xo.copy(n).invert(),e.boundsTree)return ue(i,r,sc),sc.matrix.copy(xo),sc.needsUpdate=!0,e.boundsTree.shapecast({intersectsBounds:x=>sc.intersectsBox(x),intersectsTriangle:x=>{x.a.applyMatrix4(n),x.b.applyMatrix4(n),x.c.applyMatrix4(n),x.needsUpdate=!0;for(let M=y*3,v=(p+y)*3;M<v;M+=3)if(he(pr,M,h,f),pr.needsUpdate=!0,x.intersectsTriangle(pr))return!0;return!1}});{let m=$i(e);for(let x=y*3,M=(p+y)*3;x<M;x+=3){he(dr,x,h,f),dr.a.applyMatrix4(xo),dr.b.applyMatrix4(xo),dr.c.applyMatrix4(xo),dr.needsUpdate=!0;for(let v=0,S=m*3;v<S;v+=3)if(he(pr,v,d,g),pr.needsUpdate=!0,dr.intersectsTriangle(pr))return!0}}}else{let u=te(i),h=ee(i,l);return ue(u,r,ic),!!(s.intersectsBox(ic)&&Ph(u,t,e,n,s)||(ue(h,r,ic),s.intersectsBox(ic)&&Ph(h,t,e,n,s)))}}var rc=new zt,Ih=new we,_o=new we,UM=new N,FM=new N,OM=new N,BM=new N;function Am(i,t,e,n={},s={},r=0,o=1/0){t.boundingBox||t.computeBoundingBox(),Ih.set(t.boundingBox.min,t.boundingBox.max,e),Ih.needsUpdate=!0;let l=i.geometry,a=l.attributes.position,c=l.index,u=t.attributes.position,h=t.index,f=cn.getPrimitive(),d=cn.getPrimitive(),g=UM,y=FM,p=null,m=null;s&&(p=OM,m=BM);let x=1/0,M=null,v=null;return rc.copy(e).invert(),_o.matrix.copy(rc),i.shapecast({boundsTraverseOrder:S=>Ih.distanceToBox(S),intersectsBounds:(S,A,_)=>_<x&&_<o?(A&&(_o.min.copy(S.min),_o.max.copy(S.max),_o.needsUpdate=!0),!0):!1,intersectsRange:(S,A)=>{if(t.boundsTree)return t.boundsTree.shapecast({boundsTraverseOrder:b=>_o.distanceToBox(b),intersectsBounds:(b,L,E)=>E<x&&E<o,intersectsRange:(b,L)=>{for(let E=b,C=b+L;E<C;E++){he(d,3*E,h,u),d.a.applyMatrix4(e),d.b.applyMatrix4(e),d.c.applyMatrix4(e),d.needsUpdate=!0;for(let I=S,U=S+A;I<U;I++){he(f,3*I,c,a),f.needsUpdate=!0;let P=f.distanceToTriangle(d,g,p);if(P<x&&(y.copy(g),m&&m.copy(p),x=P,M=I,v=E),P<r)return!0}}}});{let _=$i(t);for(let b=0,L=_;b<L;b++){he(d,3*b,h,u),d.a.applyMatrix4(e),d.b.applyMatrix4(e),d.c.applyMatrix4(e),d.needsUpdate=!0;for(let E=S,C=S+A;E<C;E++){he(f,3*E,c,a),f.needsUpdate=!0;let I=f.distanceToTriangle(d,g,p);if(I<x&&(y.copy(g),m&&m.copy(p),x=I,M=E,v=b),I<r)return!0}}}}}),cn.releasePrimitive(f),cn.releasePrimitive(d),x===1/0?null:(n.point?n.point.copy(y):n.point=y.clone(),n.distance=x,n.faceIndex=M,s&&(s.point?s.point.copy(m):s.point=m.clone(),s.point.applyMatrix4(rc),y.applyMatrix4(rc),s.distance=y.sub(s.point).length(),s.faceIndex=v),n)}function Tm(i,t=null){t&&Array.isArray(t)&&(t=new Set(t));let e=i.geometry,n=e.index?e.index.array:null,s=e.attributes.position,r,o,l,a,c=0,u=i._roots;for(let f=0,d=u.length;f<d;f++)r=u[f],o=new Uint32Array(r),l=new Uint16Array(r),a=new Float32Array(r),h(0,c),c+=r.byteLength;function h(f,d,g=!1){let y=f*2;if(Jt(y,l)){let p=ie(f,o),m=oe(y,l),x=1/0,M=1/0,v=1/0,S=-1/0,A=-1/0,_=-1/0;for(let b=p,L=p+m;b<L;b++){let E=3*i.resolveTriangleIndex(b);for(let C=0;C<3;C++){let I=E+C;I=n?n[I]:I;let U=s.getX(I),P=s.getY(I),B=s.getZ(I);U<x&&(x=U),U>S&&(S=U),P<M&&(M=P),P>A&&(A=P),B<v&&(v=B),B>_&&(_=B)}}return a[f+0]!==x||a[f+1]!==M||a[f+2]!==v||a[f+3]!==S||a[f+4]!==A||a[f+5]!==_?(a[f+0]=x,a[f+1]=M,a[f+2]=v,a[f+3]=S,a[f+4]=A,a[f+5]=_,!0):!1}else{let p=te(f),m=ee(f,o),x=g,M=!1,v=!1;if(t){if(!x){let E=p/8+d/32,C=m/8+d/32;M=t.has(E),v=t.has(C),x=!M&&!v}}else M=!0,v=!0;let S=x||M,A=x||v,_=!1;S&&(_=h(p,d,x));let b=!1;A&&(b=h(m,d,x));let L=_||b;if(L)for(let E=0;E<3;E++){let C=p+E,I=m+E,U=a[C],P=a[C+3],B=a[I],H=a[I+3];a[f+E]=U<B?U:B,a[f+E+3]=P>H?P:H}return L}}}function Em(i,t,e,n,s,r,o){Ht.setBuffer(i._roots[t]),en(0,Ht.float32Array,n,r,o)&&Lh(0,i,e,n,s,r,o),Ht.clearBuffer()}function Lh(i,t,e,n,s,r,o){let{float32Array:l,uint16Array:a,uint32Array:c}=Ht,u=i*2;if(Jt(u,a)){let f=ie(i,c),d=oe(u,a);_m(t,e,n,f,d,s,r,o)}else{let f=te(i);en(f,l,n,r,o)&&Lh(f,t,e,n,s,r,o);let d=ee(i,c);en(d,l,n,r,o)&&Lh(d,t,e,n,s,r,o)}}var zM=["x","y","z"];function Rm(i,t,e,n,s,r){Ht.setBuffer(i._roots[t]);let o=null;return en(0,Ht.float32Array,n,s,r)&&(o=Nh(0,i,e,n,s,r)),Ht.clearBuffer(),o}function Nh(i,t,e,n,s,r){let{float32Array:o,uint16Array:l,uint32Array:a}=Ht,c=i*2;if(Jt(c,l)){let h=ie(i,a),f=oe(c,l);return ym(t,e,n,h,f,s,r)}else{let h=sr(i,a),f=zM[h],g=n.direction[f]>=0,y,p;g?(y=te(i),p=ee(i,a)):(y=ee(i,a),p=te(i));let x=en(y,o,n,s,r)?Nh(y,t,e,n,s,r):null;if(x){let S=x.point[f];if(g?S<=o[p+h]:S>=o[p+h+3])return x}let v=en(p,o,n,s,r)?Nh(p,t,e,n,s,r):null;return x&&v?x.distance<=v.distance?x:v:x||v||null}}var oc=new _e,mr=new Ye,gr=new Ye,yo=new zt,Cm=new we,ac=new we;function Pm(i,t,e,n){Ht.setBuffer(i._roots[t]);let s=Dh(0,i,e,n);return Ht.clearBuffer(),s}function Dh(i,t,e,n,s=null){let{float32Array:r,uint16Array:o,uint32Array:l}=Ht,a=i*2;if(s===null&&(e.boundingBox||e.computeBoundingBox(),Cm.set(e.boundingBox.min,e.boundingBox.max,n),s=Cm),Jt(a,o)){let u=t.geometry,h=u.index,f=u.attributes.position,d=e.index,g=e.attributes.position,y=ie(i,l),p=oe(a,o);if(yo.copy(n).invert(),e.boundsTree)return ue(i,r,ac),ac.matrix.copy(yo),ac.needsUpdate=!0,e.boundsTree.shapecast({intersectsBounds:x=>ac.intersectsBox(x),intersectsTriangle:x=>{x.a.applyMatrix4(n),x.b.applyMatrix4(n),x.c.applyMatrix4(n),x.needsUpdate=!0;for(let M=y,v=p+y;M<v;M++)if(he(gr,3*t.resolveTriangleIndex(M),h,f),gr.needsUpdate=!0,x.intersectsTriangle(gr))return!0;return!1}});{let m=$i(e);for(let x=y,M=p+y;x<M;x++){let v=t.resolveTriangleIndex(x);he(mr,3*v,h,f),mr.a.applyMatrix4(yo),mr.b.applyMatrix4(yo),mr.c.applyMatrix4(yo),mr.needsUpdate=!0;for(let S=0,A=m*3;S<A;S+=3)if(he(gr,S,d,g),gr.needsUpdate=!0,mr.intersectsTriangle(gr))return!0}}}else{let u=te(i),h=ee(i,l);return ue(u,r,oc),!!(s.intersectsBox(oc)&&Dh(u,t,e,n,s)||(ue(h,r,oc),s.intersectsBox(oc)&&Dh(h,t,e,n,s)))}}var lc=new zt,Uh=new we,vo=new we,kM=new N,VM=new N,GM=new N,HM=new N;function Im(i,t,e,n={},s={},r=0,o=1/0){t.boundingBox||t.computeBoundingBox(),Uh.set(t.boundingBox.min,t.boundingBox.max,e),Uh.needsUpdate=!0;let l=i.geometry,a=l.attributes.position,c=l.index,u=t.attributes.position,h=t.index,f=cn.getPrimitive(),d=cn.getPrimitive(),g=kM,y=VM,p=null,m=null;s&&(p=GM,m=HM);let x=1/0,M=null,v=null;return lc.copy(e).invert(),vo.matrix.copy(lc),i.shapecast({boundsTraverseOrder:S=>Uh.distanceToBox(S),intersectsBounds:(S,A,_)=>_<x&&_<o?(A&&(vo.min.copy(S.min),vo.max.copy(S.max),vo.needsUpdate=!0),!0):!1,intersectsRange:(S,A)=>{if(t.boundsTree){let _=t.boundsTree;return _.shapecast({boundsTraverseOrder:b=>vo.distanceToBox(b),intersectsBounds:(b,L,E)=>E<x&&E<o,intersectsRange:(b,L)=>{for(let E=b,C=b+L;E<C;E++){let I=_.resolveTriangleIndex(E);he(d,3*I,h,u),d.a.applyMatrix4(e),d.b.applyMatrix4(e),d.c.applyMatrix4(e),d.needsUpdate=!0;for(let U=S,P=S+A;U<P;U++){let B=i.resolveTriangleIndex(U);he(f,3*B,c,a),f.needsUpdate=!0;let H=f.distanceToTriangle(d,g,p);if(H<x&&(y.copy(g),m&&m.copy(p),x=H,M=U,v=E),H<r)return!0}}}})}else{let _=$i(t);for(let b=0,L=_;b<L;b++){he(d,3*b,h,u),d.a.applyMatrix4(e),d.b.applyMatrix4(e),d.c.applyMatrix4(e),d.needsUpdate=!0;for(let E=S,C=S+A;E<C;E++){let I=i.resolveTriangleIndex(E);he(f,3*I,c,a),f.needsUpdate=!0;let U=f.distanceToTriangle(d,g,p);if(U<x&&(y.copy(g),m&&m.copy(p),x=U,M=E,v=b),U<r)return!0}}}}}),cn.releasePrimitive(f),cn.releasePrimitive(d),x===1/0?null:(n.point?n.point.copy(y):n.point=y.clone(),n.distance=x,n.faceIndex=M,s&&(s.point?s.point.copy(m):s.point=m.clone(),s.point.applyMatrix4(lc),y.applyMatrix4(lc),s.distance=y.sub(s.point).length(),s.faceIndex=v),n)}function Fh(i,t,e){return i===null?null:(i.point.applyMatrix4(t.matrixWorld),i.distance=i.point.distanceTo(e.ray.origin),i.object=t,i)}var cc=new we,uc=new In,Lm=new N,Nm=new zt,Dm=new N,Oh=["getX","getY","getZ"],hc=class i extends Ql{static serialize(t,e={}){e={cloneBuffers:!0,...e};let n=t.geometry,s=t._roots,r=t._indirectBuffer,o=n.getIndex(),l={version:1,roots:null,index:null,indirectBuffer:null};return e.cloneBuffers?(l.roots=s.map(a=>a.slice()),l.index=o?o.array.slice():null,l.indirectBuffer=r?r.slice():null):(l.roots=s,l.index=o?o.array:null,l.indirectBuffer=r),l}static deserialize(t,e,n={}){n={setIndex:!0,indirect:!!t.indirectBuffer,...n};let{index:s,roots:r,indirectBuffer:o}=t;t.version||(console.warn("MeshBVH.deserialize: Serialization format has been changed and will be fixed up. It is recommended to regenerate any stored serialized data."),a(r));let l=new i(e,{...n,[uo]:!0});if(l._roots=r,l._indirectBuffer=o||null,n.setIndex){let c=e.getIndex();if(c===null){let u=new Ae(t.index,1,!1);e.setIndex(u)}else c.array!==s&&(c.array.set(s),c.needsUpdate=!0)}return l;function a(c){for(let u=0;u<c.length;u++){let h=c[u],f=new Uint32Array(h),d=new Uint16Array(h);for(let g=0,y=h.byteLength/32;g<y;g++){let p=8*g,m=2*p;Jt(m,d)||(f[p+6]=f[p+6]/8-g)}}}}get primitiveStride(){return 3}get resolveTriangleIndex(){return this.resolvePrimitiveIndex}constructor(t,e={}){e.maxLeafTris&&(console.warn('MeshBVH: "maxLeafTris" option has been deprecated. Use "targetLeafSize", instead.'),e={...e,targetLeafSize:e.maxLeafTris}),super(t,e)}shiftTriangleOffsets(t){return super.shiftPrimitiveOffsets(t)}writePrimitiveBounds(t,e,n){let s=this.geometry,r=this._indirectBuffer,o=s.attributes.position,l=s.index?s.index.array:null,c=(r?r[t]:t)*3,u=c+0,h=c+1,f=c+2;l&&(u=l[u],h=l[h],f=l[f]);for(let d=0;d<3;d++){let g=o[Oh[d]](u),y=o[Oh[d]](h),p=o[Oh[d]](f),m=g;y<m&&(m=y),p<m&&(m=p);let x=g;y>x&&(x=y),p>x&&(x=p),e[n+d]=m,e[n+d+3]=x}return e}computePrimitiveBounds(t,e,n){let s=this.geometry,r=this._indirectBuffer,o=s.attributes.position,l=s.index?s.index.array:null,a=o.normalized;if(t<0||e+t-n.offset>n.length/6)throw new Error("MeshBVH: compute triangle bounds range is invalid.");let c=o.array,u=o.offset||0,h=3;o.isInterleavedBufferAttribute&&(h=o.data.stride);let f=["getX","getY","getZ"],d=n.offset;for(let g=t,y=t+e;g<y;g++){let m=(r?r[g]:g)*3,x=(g-d)*6,M=m+0,v=m+1,S=m+2;l&&(M=l[M],v=l[v],S=l[S]),a||(M=M*h+u,v=v*h+u,S=S*h+u);for(let A=0;A<3;A++){let _,b,L;a?(_=o[f[A]](M),b=o[f[A]](v),L=o[f[A]](S)):(_=c[M+A],b=c[v+A],L=c[S+A]);let E=_;b<E&&(E=b),L<E&&(E=L);let C=_;b>C&&(C=b),L>C&&(C=L);let I=(C-E)/2,U=A*2;n[x+U+0]=E+I,n[x+U+1]=I+(Math.abs(E)+I)*ir}}return n}raycastObject3D(t,e,n=[]){let{material:s}=t;if(s===void 0)return;Nm.copy(t.matrixWorld).invert(),uc.copy(e.ray).applyMatrix4(Nm),Dm.setFromMatrixScale(t.matrixWorld),Lm.copy(uc.direction).multiply(Dm);let r=Lm.length(),o=e.near/r,l=e.far/r;if(e.firstHitOnly===!0){let a=this.raycastFirst(uc,s,o,l);a=Fh(a,t,e),a&&n.push(a)}else{let a=this.raycast(uc,s,o,l);for(let c=0,u=a.length;c<u;c++){let h=Fh(a[c],t,e);h&&n.push(h)}}return n}refit(t=null){return(this.indirect?Tm:xm)(this,t)}raycast(t,e=Vn,n=0,s=1/0){let r=this._roots,o=[],l=this.indirect?Em:Mm;for(let a=0,c=r.length;a<c;a++)l(this,a,e,t,o,n,s);return o}raycastFirst(t,e=Vn,n=0,s=1/0){let r=this._roots,o=null,l=this.indirect?Rm:Sm;for(let a=0,c=r.length;a<c;a++){let u=l(this,a,e,t,n,s);u!=null&&(o==null||u.distance<o.distance)&&(o=u)}return o}intersectsGeometry(t,e){let n=!1,s=this._roots,r=this.indirect?Pm:wm;for(let o=0,l=s.length;o<l&&(n=r(this,o,t,e),!n);o++);return n}shapecast(t){let e=cn.getPrimitive(),n=super.shapecast({...t,intersectsPrimitive:t.intersectsTriangle,scratchPrimitive:e,iterate:this.indirect?vm:gm});return cn.releasePrimitive(e),n}bvhcast(t,e,n){let{intersectsRanges:s,intersectsTriangles:r}=n,o=cn.getPrimitive(),l=this.geometry.index,a=this.geometry.attributes.position,c=this.indirect?g=>{let y=this.resolveTriangleIndex(g);he(o,y*3,l,a)}:g=>{he(o,g*3,l,a)},u=cn.getPrimitive(),h=t.geometry.index,f=t.geometry.attributes.position,d=t.indirect?g=>{let y=t.resolveTriangleIndex(g);he(u,y*3,h,f)}:g=>{he(u,g*3,h,f)};if(r){if(!(t instanceof i))throw new Error('MeshBVH: "intersectsTriangles" callback can only be used with another MeshBVH.');let g=(y,p,m,x,M,v,S,A)=>{for(let _=m,b=m+x;_<b;_++){d(_),u.a.applyMatrix4(e),u.b.applyMatrix4(e),u.c.applyMatrix4(e),u.needsUpdate=!0;for(let L=y,E=y+p;L<E;L++)if(c(L),o.needsUpdate=!0,r(o,u,L,_,M,v,S,A))return!0}return!1};if(s){let y=s;s=function(p,m,x,M,v,S,A,_){return y(p,m,x,M,v,S,A,_)?!0:g(p,m,x,M,v,S,A,_)}}else s=g}return super.bvhcast(t,e,{intersectsRanges:s})}intersectsBox(t,e){return cc.set(t.min,t.max,e),cc.needsUpdate=!0,this.shapecast({intersectsBounds:n=>cc.intersectsBox(n),intersectsTriangle:n=>cc.intersectsTriangle(n)})}intersectsSphere(t){return this.shapecast({intersectsBounds:e=>t.intersectsBox(e),intersectsTriangle:e=>e.intersectsSphere(t)})}closestPointToGeometry(t,e,n={},s={},r=0,o=1/0){return(this.indirect?Im:Am)(this,t,e,n,s,r,o)}closestPointToPoint(t,e={},n=0,s=1/0){return lm(this,t,e,n,s)}};var WM=65535,fc=class{constructor(t,e){this.meta=t;let{low:n,high:s}=t.part,r=e.get("mesh.position"),o=r.rows;this.position=new Float32Array(3*o);for(let u=0;u<3;u++){let h=(s[u]-n[u])/65535;for(let f=0;f<o;f++)this.position[3*f+u]=n[u]+h*r.values[u*o+f]}this.cell=new Float64Array(o);for(let u=0;u<o;u++)this.cell[u]=r.values[u]+65536*(r.values[o+u]+65536*r.values[2*o+u]);let l=e.get("mesh.normal");this.normal=new Int8Array(4*o);for(let u=0;u<o;u++){let h=wo((l.values[u]-127)/127,(l.values[o+u]-127)/127);for(let f=0;f<3;f++)this.normal[4*u+f]=Math.round(127*h[f])}let a=e.get("mesh.texel");this.texel=new Float32Array(2*o);for(let u=0;u<o;u++){let h=a.values[u]===WM;this.texel[2*u]=h?-1:a.values[u]/16,this.texel[2*u+1]=h?-1:a.values[o+u]/16}let c=e.get("mesh.triangle");this.triangle=new Uint32Array(3*c.rows);for(let u=0;u<3;u++)for(let h=0;h<c.rows;h++)this.triangle[3*h+u]=c.values[u*c.rows+h];this.owner=new Float32Array(o),this.ofFaces=t.faces.reduce((u,h)=>Math.max(u,h.start+h.count),0),this.sheet=new Uint16Array(4*o),t.faces.forEach((u,h)=>{this.own(u,h),this.lay(u)}),t.fixtures.forEach((u,h)=>this.own(u,-1-h))}meta;position;normal;texel;owner;sheet;triangle;cell;ofFaces;setup=0;made=null;there(t){return t>=0||this.meta.fixtures[-1-t].setups.includes(this.setup)}get shownVertices(){let t=this.shown.get(this.setup);if(!t){let e=0;for(let a=0;a<3*this.ofFaces;a++)e=Math.max(e,this.triangle[a]+1);t=this.position.slice();let n=t.subarray(0,3*e),s=this.partRadius,[r,o]=[[],[]];for(let a=0;a<3;a++){[r[a],o[a]]=[1/0,-1/0];for(let c=a;c<n.length;c+=3)r[a]=Math.min(r[a],n[c]),o[a]=Math.max(o[a],n[c])}let l=n.length;for(let a=e;a<this.owner.length&&e;a++)if(this.there(this.owner[a]))for(let c=0;c<3;c++)t[l++]=Math.min(o[c]+s,Math.max(r[c]-s,this.position[3*a+c]));t=t.slice(0,l),this.shown.set(this.setup,t)}return t}shown=new Map;get partRadius(){let[t,e,n]=this.meta.part.size_mm;return Math.max(1e-6,Math.hypot(t,e,n)/2)}own(t,e){let n=3*(t.start+t.count);for(let s=3*t.start;s<n;s++)this.owner[this.triangle[s]]=e}lay({start:t,count:e}){let{texel:n,triangle:s,sheet:r}=this,o=s.subarray(3*t,3*(t+e)),l=[1/0,1/0,-1/0,-1/0],a=!0;for(let c=0;c<o.length;c++){let[u,h]=[n[2*o[c]],n[2*o[c]+1]];if(u<0)return;let f=o[c-c%3];a&&=u===n[2*f]&&h===n[2*f+1],l[0]=Math.min(l[0],u),l[1]=Math.min(l[1],h),l[2]=Math.max(l[2],u),l[3]=Math.max(l[3],h)}for(let c of o)for(let u=0;u<4;u++)r[4*c+u]=a?Math.round(n[2*c+u%2]):u<2?Math.floor(l[u]):Math.ceil(l[u])}geometry(t,e){let n=new Xe;return n.setAttribute("position",this.shared("position",this.position,3)),n.setAttribute("normal",this.shared("normal",this.normal,4)),n.setAttribute("texel",this.shared("texel",this.texel,2)),n.setAttribute("sheet",this.shared("sheet",this.sheet,4)),n.setAttribute("owner",this.shared("owner",this.owner,1)),n.setIndex(new Ae(this.triangle.subarray(3*t,3*(t+e)),1)),n}attributes=new Map;shared(t,e,n){let s=this.attributes.get(t);return s||(s=new Ae(e,n,e instanceof Int8Array),this.attributes.set(t,s)),s}get tree(){if(!this.made){let t=new Xe;t.setAttribute("position",new Ae(this.position,3)),t.setIndex(new Ae(this.triangle.slice(),1)),this.made=new hc(t,{targetLeafSize:8})}return this.made}called(t){return t>=0?this.meta.faces[t]?.id??"":`fixture ${this.meta.fixtures[-1-t]?.name.replace(/^fixture:/,"")??""}`}ownerOf(t){if(!t)return null;let e=this.meta.faces.findIndex(r=>r.id===t);if(e>=0)return e;let n=this.meta.fixtures.map(r=>t===`fixture:${r.name}`||t===r.name),s=n.findIndex((r,o)=>r&&this.there(-1-o));return s>=0?-1-s:n.includes(!0)?-1-n.indexOf(!0):null}rangeOf(t){let e=t>=0?this.meta.faces[t]:this.meta.fixtures[-1-t];return e?.count?e:null}middle(t){let e=this.rangeOf(t);if(!e)return null;let n=[1/0,1/0,1/0],s=[-1/0,-1/0,-1/0];for(let r=3*e.start;r<3*(e.start+e.count);r++)for(let o=0;o<3;o++){let l=this.position[3*this.triangle[r]+o];n[o]=Math.min(n[o],l),s[o]=Math.max(s[o],l)}return{centre:n.map((r,o)=>(r+s[o])/2),radius:Math.hypot(s[0]-n[0],s[1]-n[1],s[2]-n[2])/2}}};var dc=class{constructor(t,e){this.stage=t;this.drawn=e;this.contour.uniforms.mask.value=this.mask.texture;let n=new de(new yi(2,2),this.contour);n.frustumCulled=!1,this.over.add(n),t.afterDraw(()=>this.draw())}stage;drawn;owner=null;of=new Oi;over=new Oi;mask=new on(1,1,{depthBuffer:!1});contour=Tp();geometries=new Map;show(t){if(t===this.owner)return;this.owner=t,this.of.clear();let e=t===null?null:this.drawn.rangeOf(t);if(t===null||!e)return;let n=this.geometries.get(t);n||this.geometries.set(t,n=this.drawn.geometry(e.start,e.count));let s=new de(n,this.material);s.frustumCulled=!1,this.of.add(s)}material=Ap();draw(){if(this.owner===null||!this.of.children.length)return;let{renderer:t,table:e}=this.stage,n=t.getDrawingBufferSize(new Et);this.mask.setSize(n.x,n.y),t.setRenderTarget(this.mask),t.render(this.of,e.camera),t.setRenderTarget(null),t.autoClear=!1,t.render(this.over,e.camera),t.autoClear=!0}};var XM=64,qM=255,pc=class{constructor(t,e,n){this.drawn=t;this.material=n;[this.width,this.height]=t.meta.atlas??[1,1],this.index=t.meta.atlas?e.get("atlas.index").values:[-1],this.texture=Pp(this.width,this.height),this.material.uniforms.colours.value=this.texture,t.ofFaces&&this.group.add(new de(t.geometry(0,t.ofFaces),this.material)),t.meta.fixtures.forEach(({start:s,count:r},o)=>{let l=new de(t.geometry(s,r),this.material);this.fixtures.push([-1-o,l]),r&&this.group.add(l)}),this.stand()}drawn;material;group=new _n;texture;index;width;height;fixtures=[];stand(){for(let[t,e]of this.fixtures)e.visible=this.drawn.there(t)}paint(t,e=null){let n=this.texture.image.data,s=new Uint32Array(n.buffer),r=new Uint32Array(t.bytes.buffer,t.bytes.byteOffset,t.bytes.length/4),o=c=>new Uint32Array(new Uint8Array([0,0,0,c]).buffer)[0],[l,a]=[o(qM),o(XM)];for(let c=0;c<s.length;c++){let u=this.index[c];s[c]=u<0?l:e&&!e(u)?r[u]|a:r[u]}this.texture.needsUpdate=!0}sampleAt(t,e){if(t<-.5)return null;let n=Math.min(this.width-1,Math.max(0,Math.round(t))),s=Math.min(this.height-1,Math.max(0,Math.round(e))),r=this.index[s*this.width+n];return r>=0?r:null}neighbours(t){let e=this.places().get(t);if(e===void 0)return[null,null,null,null];let[n,s]=[e%this.width,Math.floor(e/this.width)],r=([o,l])=>{for(let a=1;a<4;a++){let[c,u]=[n+a*o,s+a*l];if(c<0||u<0||c>=this.width||u>=this.height)return null;let h=this.index[u*this.width+c];if(h<0)return null;if(h!==t)return h}return null};return[[-1,0],[1,0],[0,-1],[0,1]].map(r)}place=null;places(){if(!this.place){this.place=new Map;for(let t=0;t<this.index.length;t++)this.index[t]>=0&&!this.place.has(this.index[t])&&this.place.set(this.index[t],t)}return this.place}light(t,e){this.material.uniforms.hot.value=t??co,this.material.uniforms.held.value=e??co}};var mc=class{constructor(t,e,n){this.stage=t;this.drawn=e;this.part=n}stage;drawn;part;caster=new Yr;at(t,e){this.caster.setFromCamera(new Et(t,e),this.stage.table.camera);let n=ei.plane.value,s=this.drawn.tree.raycast(this.caster.ray,ye).filter(({face:x,point:M})=>x&&this.drawn.there(this.drawn.owner[x.a])&&n.x*M.x+n.y*M.y+n.z*M.z<=n.w).sort((x,M)=>x.distance-M.distance)[0];if(!s?.face)return null;let{a:r,b:o,c:l}=s.face,{position:a,texel:c}=this.drawn,[u,h,f]=[r,o,l].map(x=>new N().fromArray(a,3*x)),d=ke.getBarycoord(s.point,u,h,f,new N)??new N(1,0,0),[g,y,p]=d.toArray(),m=x=>g*c[2*r+x]+y*c[2*o+x]+p*c[2*l+x];return{point:s.point.toArray(),owner:this.drawn.owner[r],sample:c[2*r]<0?null:this.part.sampleAt(m(0),m(1))}}hidden(t,e){let n=1e-4*this.stage.table.radius,s=new In(new N(...ce(t,e,n)),new N(...e)),{owner:r,tree:o}=this.drawn;return o.raycast(s,ye).some(({face:l})=>l&&this.drawn.there(r[l.a]))}};var YM=4;function Fm(i,t,e,n){let{stage:s}=i,{canvas:r,table:o}=s,l=null,a=0;r.addEventListener("contextmenu",f=>f.preventDefault()),r.addEventListener("pointerdown",f=>{r.setPointerCapture(f.pointerId),l={x:f.clientX,y:f.clientY,pan:f.button!==0||f.shiftKey,moved:!1}}),r.addEventListener("pointermove",f=>{if(!l){cancelAnimationFrame(a),a=requestAnimationFrame(()=>u(f));return}let[d,g]=[f.clientX-l.x,f.clientY-l.y];!l.moved&&Math.hypot(d,g)<YM||(l={...l,x:f.clientX,y:f.clientY,moved:!0},l.pan?o.pan(d/r.clientHeight,g/r.clientHeight):o.orbit(-.45*d,.45*g))});let c=f=>{let d=l&&!l.moved&&!l.pan&&f.type==="pointerup";if(l=null,!d)return;let g=s.place(f);f.ctrlKey||f.metaKey?e.toggle(i.picker.at(...g)?.owner??null):h(...g)};r.addEventListener("pointerup",c),r.addEventListener("pointercancel",c),r.addEventListener("pointerleave",()=>{cancelAnimationFrame(a),i.hover(null),n("")}),r.addEventListener("wheel",f=>{f.preventDefault();let d=f.deltaMode===1?16:1;o.zoom(Math.exp(-.0015*d*f.deltaY),...s.place(f))},{passive:!1});let u=f=>{let d=i.picker.at(...s.place(f));if(i.hover(d?d.owner:null),!d)return n("");let g=i.meta.faces[d.owner],y=g?.name&&g.name!==g.id?`, ${g.name}`:"",p=d.sample===null?"":`: ${be(i.meta,i.samples.verdict(i.cutter.id,d.sample))}`,m=d.sample===null?null:i.operationAt(d.sample);n(`${i.drawn.called(d.owner)}${y}${m?`: ${m.label}, ${m.turned}`:p}`)},h=(f,d)=>{let g=i.picker.at(f,d);if(t.on){g&&t.add(g.point);return}if(!g||g.sample===null){i.say(g?`${i.drawn.called(g.owner)} has no samples`:"Nothing is there");return}Um(i,g.sample)};r.addEventListener("keydown",f=>{if(f.key!=="Enter")return;let d=i.picker.at(0,0);if(d&&(t.on||d.sample!==null))return h(0,0);let g=$M(i);if(g===null)return i.say("No sample is in the picture");t.on?t.add(i.samples.point(g)):Um(i,g)})}function Um(i,t){let e=i.operationAt(t)?.cutter;e&&e!==i.cutter.id&&i.setCutter(e),i.select(t);let{meta:n,samples:s}=i,r=i.faceShown(),o=s.reason(i.cutter.id,t),l=be(n,s.verdict(i.cutter.id,t))+(o?` (${be(n,o)})`:"");i.say(`${r===null?"":`${i.drawn.called(r)}, `}sample ${t}: ${l}`)}function $M(i){let{samples:t,stage:e,picker:n}=i,{back:s}=e.table.frame(),[r,o]=[e.canvas.clientWidth,e.canvas.clientHeight],l=[];for(let a=0;a<t.count;a++){let c=t.normal(a);if(c[0]*s[0]+c[1]*s[1]+c[2]*s[2]<=0)continue;let[u,h]=e.project(t.point(a)),[f,d]=[2*u/r-1,1-2*h/o];Math.abs(f)<1&&Math.abs(d)<1&&l.push([f*f+d*d,a,f,d])}l.sort((a,c)=>a[0]-c[0]);for(let[,a,c,u]of l.slice(0,40)){let h=n.at(c,u);if(h?.owner!==void 0&&i.meta.faces[h.owner]?.number===t.face.values[a])return a}return l.length?l[0][1]:null}function gc(i,t,e,n){return re(i,async()=>{let s=t();e(await ZM(s)?`Copied: ${s}`:`This browser does not let the page copy. Copy it by hand: ${s}`)},{class:"copy",title:n,"aria-label":n})}async function ZM(i){try{return await navigator.clipboard.writeText(i),!0}catch{let t=Y("textarea",{class:"aside","aria-hidden":"true",tabindex:-1}),e=document.activeElement;t.value=i,document.body.append(t),t.select();let n=document.execCommand("copy");return t.remove(),e?.focus(),n}}var Om={angle:2,axis:4},xc=class{constructor(t){this.app=t;t.on("posture",()=>this.told())}app;root=Y("div",{id:"angles"});told(){let{app:t}=this,e=t.placed()?.axis;if(this.root.hidden=!e,!e)return;let n=e.map(c=>Bm(c,Om.axis)).join(", "),s=[this.row("Tool axis",n,"",`Copy the tool axis ${n}`)],{kinematics:r}=t.machine,o=t.meta.axes,l=o.length?t.machine.positions(e):[];r&&o.length&&!l.length&&s.push(Y("p",{class:"hint"},`No angles of ${o.join(" and ")} hold this tool axis.`)),l.forEach((c,u)=>{let h=KM(o,c),f=l.length>1?`Solution ${u+1}`:o.length>1?"Angles":"Angle";s.push(this.row(f,h.join(", "),QM(o,c),`Copy ${h.join(" ")}`,h.join(" ")))}),(r&&r.direction.length===2&&l.length>0?Ss(Le(e,r.direction[0])):1)<=Math.sin(2/fn)&&s.push(Y("p",{class:"hint"},`Singular: the tool axis is nearly along ${o[0]}, which turns fast there.`)),this.root.replaceChildren(...s)}warning(t){let{state:e}=this.app;return`${e?.state==="free"?e.certified?"":". This posture is not certified":". This posture is not free"}${t?`. ${t.charAt(0).toUpperCase()}${t.slice(1)}`:""}`}row(t,e,n,s,r=e){let o=n?Y("span",{class:"hint"},` ${n}`):null;return Y("p",{class:"angle"},Y("span",{class:"what"},t),Y("span",{class:"value"},e,o),gc("Copy",()=>r,l=>this.app.say(l+this.warning(n)),s))}},KM=(i,{angles:t})=>i.map((e,n)=>`${e}${Bm(t[n],Om.angle)}`).sort();function QM(i,{within:t,free:e}){let n=i.filter((s,r)=>!t[r]);return n.length?`beyond the limit of ${n.join(" and ")}`:e?`any ${i[0]} serves`:""}function Bm(i,t){let e=Number(i.toFixed(t));return String(Object.is(e,-0)?0:e)}var jM=14,_c=class{constructor(t,e,n){this.app=t;this.sample=n;this.certified=tS(t,n,e.of(t.cutter.id,n.row))??eS(t,n),this.grid=Sf(t.meta)}app;sample;certified;grid;get complete(){return this.grid.done>=this.grid.rotations.length}advance(){let t=performance.now()+jM;do bf(this.grid,this.app.probe,this.app.liveTool(),this.sample);while(!this.complete&&performance.now()<t)}cell(t,e){let n=this.grid.tilts[e];if(this.freeAt(t,n))return"free";if(t>=this.grid.done)return null;let s=ts[this.grid.state[t*this.grid.tilts.length+e]];return this.certified&&s==="free"?this.unsure(t):s}freeAt(t,e){return this.certified?.free[t].some(([n,s])=>e>=n&&e<=s)??!1}unsure(t){return this.buried?"buried":this.certified.undecided[t]>0?"undecided":"tolerance"}get buried(){return this.app.samples.reason(this.app.cutter.id,this.sample.row)==="buried"}free(t){return this.certified?this.certified.free[t]:Io(this.grid.tilts,(e,n)=>this.cell(t,n)==="free")}causes(t){let e=new Map;for(let n=0;n<this.grid.tilts.length;n++){let s=this.cell(t,n);s&&s!=="free"&&e.set(s,(e.get(s)??0)+1)}return e}column(t){let e=0;return this.grid.rotations.forEach((n,s)=>{bs(n,t)<bs(this.grid.rotations[e],t)&&(e=s)}),e}at(t,e){let n=this.app.samples.posture(this.app.cutter.id,this.sample.row),s=this.app.plannedPosture();if(n&&Pi(n,t)||s&&Pi(s,t))return{state:"free",certified:!0};let r=this.column(t.rotation),o=bs(this.grid.rotations[r],t.rotation)<.02;return!this.certified||!o?{state:e.state,certified:!1}:this.freeAt(r,t.tilt)?{state:"free",certified:!0}:{state:e.state==="free"?this.unsure(r):e.state,certified:!1}}nearest(){let{grid:t,app:e}=this;for(let n of Qh){let s=[];t.rotations.forEach((l,a)=>t.tilts.forEach((c,u)=>{this.cell(a,u)===n&&s.push({tilt:c,rotation:l})}));let r=Math.max(1,Math.ceil(s.length/60)),o=null;for(let l=0;l<s.length;l+=r){let{depth:a}=e.probe.look(e.liveTool(),this.sample,s[l],!0);(!o||a<o[0])&&(o=[a,s[l]])}if(o)return o[1]}return null}};function tS(i,t,e){let{machine:n}=i;return!e||!n.limited?e:{...e,free:e.free.map((s,r)=>n.within(s,t,i.meta.rotation_deg[r]))}}function eS(i,t){let e=i.samples.verdict(i.cutter.id,t.row);if(!["inaccessible","undecided","inside_bodies"].includes(e))return null;let n=e==="undecided"?1:0;return{free:i.meta.rotation_deg.map(()=>[]),undecided:i.meta.rotation_deg.map(()=>n)}}function zm(i,{state:t,certified:e},n){if(t==="free")return e?"free":"nothing is met in the drawing, which is not certified";if(t==="undecided")return"undecided: neither called free nor known to be forbidden";let s=be(i.meta,t),r=n&&n.owner!==null?i.drawn.called(n.owner):"";return t==="fixture"?`${n?.part??"cutter"} meets ${r}`:r?`${s} with ${r}`:`${s}: ${i.meta.causes[t].sentence}`}var km="plan-cutters-scheme",nS="screen and (prefers-color-scheme: dark)",Vm={auto:nS,light:"not all",dark:"screen"};function Gm(i){let t=Y("select",{id:"scheme"},Y("option",{value:"auto"},"as the system"),Y("option",{value:"light"},"light"),Y("option",{value:"dark"},"dark")),e=iS(),n=()=>{e&&(e.media.mediaText=Vm[t.value]),i()};return t.value=sS(),t.value!=="auto"&&n(),t.addEventListener("change",()=>{n();try{localStorage.setItem(km,t.value)}catch{}}),matchMedia("(prefers-color-scheme: dark)").addEventListener("change",i),Y("label",{},"Colours ",t)}function iS(){for(let i of document.styleSheets)for(let t of i.cssRules)if(t instanceof CSSMediaRule&&t.media.mediaText.includes("prefers-color-scheme"))return t;return null}function sS(){try{let i=localStorage.getItem(km)??"";return i in Vm?i:"auto"}catch{return"auto"}}var Bh=i=>getComputedStyle(document.documentElement).getPropertyValue(`--${i}`).trim();var yc=class{constructor(t,e){this.meta=t;this.arrays=e;if(this.row=t.maps?e.get("maps.row").values:new Uint32Array,this.turns=t.rotation_deg.length,this.start=new Uint32Array(this.row.length+1),!t.maps)return;let{rows:n,columns:s,values:r}=e.get("maps.count");for(let o=0;o<s;o++)for(let l=0;l<n;l++)this.start[l+1]+=r[o*n+l];for(let o=0;o<n;o++)this.start[o+1]+=this.start[o]}meta;arrays;row;start;turns;of(t,e){if(this.meta.maps?.cutter!==t)return null;let n=this.row.indexOf(e);if(n<0)return null;let s=this.arrays.get("maps.count"),r=this.arrays.get("maps.end"),o=this.arrays.has("maps.undecided")?this.arrays.get("maps.undecided"):null,l=this.start[n],a=[],c=[];for(let u=0;u<this.turns;u++){let h=[];for(let f=0;f<s.values[u*s.rows+n];f++,l++)h.push([r.values[l]/10,r.values[r.rows+l]/10]);a.push(h),c.push(o?o.values[u*o.rows+n]/2:0)}return{free:a,undecided:c}}};var Zi=30,ys=30,xr=10,vc=10,si=226,Mc=class{constructor(t){this.app=t;this.stored=new yc(t.meta,t.arrays),this.angles=new xc(t);let e=["rotation, \xB0","free tilts, \xB0","else in the way"].map(n=>Y("th",{scope:"col"},n));this.intervals=Y("details",{},Y("summary",{},"The same as a table"),Y("table",{id:"intervals"},this.caption,Y("thead",{},Y("tr",{},...e)),this.rows)),this.empty.append("Click the surface, or press Enter in the picture, to see the postures of the cutter at a sample."),this.body.append(this.about,this.kind,this.canvas,this.line,this.angles.root,this.witness,this.tools,this.legend,this.intervals),this.root.append(this.title,this.empty,this.body),this.body.hidden=!0,this.canvas.addEventListener("pointermove",n=>this.point(n)),this.canvas.addEventListener("pointerdown",n=>this.point(n)),this.canvas.addEventListener("keydown",n=>this.key(n)),t.judge=(n,s)=>this.map?.at(n,s)??{state:s.state,certified:!1},t.on("sample",()=>this.begin()),t.on("posture",()=>this.told()),new ResizeObserver(()=>this.resize()).observe(this.root)}app;root=Y("section",{id:"posture","aria-label":"Posture map"});canvas=Y("canvas",{id:"map",tabindex:0,role:"application","aria-describedby":"posture-line"});title=Y("h2",{},"Posture map");about=Y("p",{class:"about"});kind=Y("p",{class:"kind"});line=Y("p",{id:"posture-line","aria-live":"polite"});start=re("Posture found",()=>this.back(),{id:"found-posture"});witness=Y("p",{class:"hint"});legend=Y("ul",{class:"legend","aria-label":"Legend of the posture map"});rows=Y("tbody");caption=Y("caption",{});intervals;angles;tools=Y("p",{class:"tools"},this.start);body=Y("div",{class:"posture-body"});empty=Y("p",{class:"hint"});stored;map=null;width=320;timer=0;resize(){let t=Math.max(220,Math.floor(this.root.clientWidth-24));t!==this.width&&(this.width=t,this.draw())}begin(){window.clearTimeout(this.timer);let{sample:t,cutter:e,samples:n}=this.app;if(this.body.hidden=!t,this.empty.hidden=!!t,this.title.textContent="Posture map",this.map=t&&new _c(this.app,this.stored,t),!t||!this.map)return;let s=this.app.meta.faces.find(f=>f.number===t.face),r=n.verdict(e.id,t.row),o=n.reason(e.id,t.row),l=this.app.meta.setups.length?n.setup(e.id,t.row):null,a=l===null?"":`, in setup ${l+1}`,c=n.posture(e.id,t.row),{operation:u}=this.app;this.start.textContent=u?.axis?`Posture of ${u.label}`:c?"Posture found":this.app.spot?"Posture of the witness":"Nearest posture";let h=`Posture map of sample ${t.row}: tilt against rotation; arrow keys move the tool`;this.canvas.setAttribute("aria-label",h),this.about.replaceChildren(Y("strong",{},`${s?.id??"?"}, sample ${t.row}`),` at ${n.told(t.row).map(f=>Je(f,4)).join(", ")} mm. `,Y("strong",{},e.name||e.id),`: ${be(this.app.meta,r)}${o?` (${be(this.app.meta,o)})`:""}${a}. Curvature ${t.curvature.map(rS).join(" and ")}.`),this.kind.textContent=this.map.certified?"What is free is certified. What forbids the others comes from the drawn triangles.":`Approximate: this map comes from the drawn triangles and overlooks what reaches less than ${Je(this.app.liveTool().spared,2)} mm into the tool. It is not certified.`,this.app.meta.kinematics&&this.app.meta.kinematics.direction.length<2&&(this.kind.textContent+=" This machine turns too few axes for a map: only the posture found is shown."),this.kind.classList.toggle("approximate",!this.map.certified),this.draw(),this.timer=window.setTimeout(()=>this.advance(this.map),0)}advance(t){if(t===this.map){if(t.complete||t.advance(),this.draw(),!t.complete){this.timer=window.setTimeout(()=>this.advance(t),0);return}if(this.table(t),this.root.dataset.complete=String(t.sample.row),!this.app.posture){let e=this.firstFree(t)??t.nearest();e&&this.app.setPosture(e)}}}firstFree(t){let e=null;return t.grid.rotations.forEach((n,s)=>{for(let[r,o]of t.free(s))(!e||o-r>e[0])&&(e=[o-r,{tilt:Math.round((r+o)/2),rotation:n}])}),e?e[1]:null}back(){let{sample:t}=this.app;t&&this.app.setPosture(this.app.startPosture(t.row)??this.map?.nearest()??null)}told(){let{posture:t,met:e,state:n,sample:s}=this.app;if(t&&n&&s){let r=this.app.samples.posture(this.app.cutter.id,s.row),o=this.app.plannedPosture(),a=(o&&Pi(o,t)?`, ${this.app.operation.label}`:"")||(n.state==="free"&&r&&Pi(r,t)?", the posture found":"");this.line.textContent=`tilt ${vs(t.tilt)}\xB0, rotation ${vs(t.rotation)}\xB0: `+(this.app.atWitness()?this.witnessed():zm(this.app,n,e)+a),this.line.dataset.state=n.state}else this.line.textContent="";this.witness.textContent=this.app.atWitness()?this.app.spot.text:"",this.draw()}witnessed(){let{reason:t,depth_mm:e,obstacle_face:n}=this.app.spot,s=this.app.drawn.ownerOf(n),r=s===null?n??"the part":this.app.drawn.called(s),o="(the best posture found)";if(this.app.samples.verdict(this.app.cutter.id,this.app.sample.row)==="undecided"){let l=e===null?"":`, ${r} may reach ${Je(e)} mm into the tool`;return`undecided (${be(this.app.meta,t)})${l} ${o}`}return`${be(this.app.meta,t)}${e===null?"":`; it is ${Je(e)} mm too deep in ${r}`} ${o}`}x(t){return Zi+(this.width-Zi-vc)*ai(t+this.step/2)/360}y(t){let[e,n]=this.app.meta.tilt_deg;return si-ys-(si-ys-xr)*(t-e)/Math.max(1e-9,n-e)}get step(){let t=this.app.meta.rotation_deg;return t.length>1?t[1]-t[0]:360}draw(){let{map:t,canvas:e}=this;if(!t)return;let n=Math.min(2,devicePixelRatio||1);e.width=this.width*n,e.height=si*n,e.style.width=`${this.width}px`,e.style.height=`${si}px`;let s=e.getContext("2d");s.scale(n,n);let r=new Map(ts.map(h=>[h,sf(s,...Eo(this.app.meta,h))])),o=Math.max(1,(this.width-Zi-vc)*this.step/360-1),l=new Set,{tilts:a}=t.grid;t.grid.rotations.forEach((h,f)=>{let d=this.x(h)-o/2;s.fillStyle=Bh("ground"),s.fillRect(d,xr,o,si-xr-ys);let g=0;for(let y=1;y<=a.length;y++){let p=t.cell(f,g);if(!(y<a.length&&t.cell(f,y)===p)){if(p&&p!=="free"){l.add(p),s.fillStyle=r.get(p);let m=g?(a[g-1]+a[g])/2:a[0],x=y<a.length?(a[y-1]+a[y])/2:a[y-1];s.fillRect(d,this.y(x),o,this.y(m)-this.y(x))}g=y}}s.fillStyle=t.certified?r.get("free"):Dc[0];for(let[y,p]of t.free(f))l.add("free"),s.fillRect(d,this.y(p)-.5,o,Math.max(1,this.y(y)-this.y(p)+1))}),this.axes(s),this.marks(s);let c=ts.filter(h=>l.has(h)),u=`${c.join()} ${t.certified!==null}`;this.legend.dataset.shown!==u&&(this.legend.dataset.shown=u,this.legend.replaceChildren(...c.map(h=>{let f=h==="free"&&!t.certified,d=f?"nothing met (not certified)":h==="tolerance"?"within tolerance":be(this.app.meta,h);return Y("li",{},es(...f?Dc:Eo(this.app.meta,h)),d)})))}axes(t){let[e,n]=this.app.meta.tilt_deg;t.fillStyle=Bh("soft"),t.font="11px system-ui, sans-serif",t.textAlign="right",t.textBaseline="middle";for(let s=0;s<=3;s++){let r=e+(n-e)*s/3;t.fillText(String(Math.round(r)),Zi-5,this.y(r))}t.textAlign="center",t.textBaseline="top";for(let s of[0,90,180,270])t.fillText(String(s),this.x(s),si-ys+4);t.fillText("rotation, \xB0",Zi+(this.width-Zi-vc)/2,si-13),t.save(),t.translate(2,xr+(si-xr-ys)/2),t.rotate(-Math.PI/2),t.fillText("tilt, \xB0",0,0),t.restore()}marks(t){let{sample:e,cutter:n,posture:s}=this.app,r=e&&this.app.samples.posture(n.id,e.row),o=(c,u,h,f,d)=>{t.strokeStyle=f,t.lineWidth=d,t.beginPath(),t.arc(c,u,h,0,7),t.stroke()};if(r){let[c,u]=[this.x(r.rotation),this.y(r.tilt)];t.beginPath();for(let[h,f]of[[0,-6],[6,0],[0,6],[-6,0]])t.lineTo(c+h,u+f);t.closePath(),t.fillStyle="#fff",t.fill(),t.strokeStyle="#111",t.lineWidth=1.5,t.stroke()}if(!s)return;let[l,a]=[this.x(s.rotation),this.y(s.tilt)];o(l,a,8,"#fff",4),o(l,a,8,"#111",2)}point(t){if(!this.map)return;let e=this.canvas.getBoundingClientRect(),n=(t.clientX-e.left-Zi)/(this.width-Zi-vc),[s,r]=this.app.meta.tilt_deg,o=(si-ys-(t.clientY-e.top))/(si-ys-xr);if(n<0||n>1)return;let l=this.map.column(ai(360*n-this.step/2)),a=Math.round(Math.min(r,Math.max(s,s+o*(r-s))));this.go(l,Math.min(r,Math.max(s,a)))}go(t,e){let n=this.map.grid.rotations[t],s=this.app.posture;s&&s.tilt===e&&s.rotation===n||this.app.setPosture({tilt:e,rotation:n})}key(t){let n={ArrowLeft:[-1,0],ArrowRight:[1,0],ArrowUp:[0,1],ArrowDown:[0,-1],PageUp:[0,10],PageDown:[0,-10]}[t.key];if(!n||!this.map||t.ctrlKey||t.metaKey||t.altKey)return;t.preventDefault(),t.stopPropagation();let{posture:s}=this.app,r=this.map.grid.rotations.length,[o,l]=this.app.meta.tilt_deg,a=s?this.map.column(s.rotation):0,c=Math.round(s?.tilt??o)+n[1];this.go((a+n[0]+r)%r,Math.min(l,Math.max(o,c)))}table(t){this.rows.replaceChildren(...t.grid.rotations.map((s,r)=>{let o=t.free(r).map(([a,c])=>`${vs(a)} to ${vs(c)}`),l=[...t.causes(r)].sort((a,c)=>c[1]-a[1]).map(([a])=>be(this.app.meta,a));return Y("tr",{"data-rotation":s,"data-certified":String(t.certified!==null)},Y("th",{scope:"row"},vs(s)),Y("td",{},o.join("; ")||"none"),Y("td",{},l.join(", ")))}));let e=t.grid.rotations.length*t.grid.tilts.length,n=0;t.grid.rotations.forEach((s,r)=>t.grid.tilts.forEach((o,l)=>n+=t.cell(r,l)==="free"?1:0)),this.title.textContent=`Posture map: ${bo(n/e)} ${t.certified?"free":"open"}`,this.caption.textContent=t.certified?"Free tilts by rotation":"Tilts at which nothing is met, not certified"}};function rS(i){return Number.isFinite(i)?Math.abs(i)<1e-5?"flat":`${i>0?"concave":"convex"} R ${Je(1/Math.abs(i))}`:"unknown"}var Ji={width:900,height:620},Sc=class{constructor(t){this.app=t;this.pictures.forEach((e,n)=>e.setAttribute("aria-label",`Still ${n+1} of the part`));for(let e of this.pictures)e.setAttribute("role","img");this.root.append(...this.pictures,Y("figcaption",{},"As seen on the screen, and from the opposite corner."),this.key),window.addEventListener("beforeprint",()=>this.take())}app;root=Y("figure",{id:"stills"});pictures=[Y("canvas",Ji),Y("canvas",Ji)];key=Y("div",{class:"key"});take(){let{stage:t}=this.app,{table:e}=t,n=e.aim;this.key.replaceChildren(...ph(this.app)),[n,e.fitted(n.turn+180,n.rise>0?n.rise:32)].forEach((r,o)=>{e.set(r),t.draw(!1);let l=this.pictures[o].getContext("2d"),{canvas:a}=t,c=Math.min(Ji.width/a.width,Ji.height/a.height),[u,h]=[a.width*c,a.height*c];l.clearRect(0,0,Ji.width,Ji.height),l.drawImage(a,(Ji.width-u)/2,(Ji.height-h)/2,u,h)}),e.set(n)}};var[zh,oS]=[24,100],[bc,kh]=[190,76],aS=[bc-38,38],wc=class{constructor(t){this.app=t;t.stage.afterDraw(()=>this.draw())}app;root=$t("svg",{id:"scale",viewBox:`0 0 ${bc} ${kh}`,width:bc,height:kh,role:"img"});draw(){let{canvas:t,table:e}=this.app.stage,{back:n,right:s,up:r}=e.frame(),o=[0,1,2].map(g=>({k:g,x:It(Ri(g),s),y:It(Ri(g),r),near:It(Ri(g),n)})).sort((g,y)=>g.near-y.near).map(({k:g,x:y,y:p})=>this.arm(g,y,p)),l=2*e.aim.half/Math.max(1,t.clientHeight),a=lS(oS*l),c=cS(a),[u,h]=[bc-82,kh-8],f=u-a/l,d=`M${f} ${h-6}V${h}H${u}V${h-6}`;this.root.setAttribute("aria-label",`The part's axes, and a bar of ${c}`),this.root.replaceChildren(...o,$t("path",{class:"under",d}),$t("path",{class:"bar",d}),$t("text",{x:(f+u)/2,y:h-9,"text-anchor":"middle"},c))}arm(t,e,n){let[s,r]=aS,[o,l]=[s+zh*e,r-zh*n],a=Math.max(.001,Math.hypot(e,n)),c=(zh*a+8)/a,[u,h]=a>.15?[s+c*e,r-c*n]:[s+8,r+8];return $t("g",{class:`axis ${"xyz"[t]}`},$t("line",{x1:s,y1:r,x2:o,y2:l}),$t("circle",{cx:o,cy:l,r:2.2}),$t("text",{x:u,y:h+4,"text-anchor":"middle"},"XYZ"[t]))}};function lS(i){let t=10**Math.floor(Math.log10(i));return t*([5,2].find(e=>e*t<=i)??1)}function cS(i){let[t,e]=i>=1e3?[i/1e3,"m"]:i<.1?[i*1e3,"\xB5m"]:[i,"mm"];return`${Number(t.toPrecision(1))} ${e}`}var Ac=class{constructor(t){this.app=t;this.root.append(Y("span",{},"Selected: "),this.words,gc("Copy for --faces",()=>this.text,t.say,"Copy for --faces: the selected faces as text"),re("Clear",()=>this.clear())),t.stage.add(this.tints),this.show()}app;root=Y("div",{id:"selection",role:"group","aria-label":"Selected faces"});picked=new Set;tints=new _n;material=er("0.45, 0.12, 0.85, 0.5",{transparent:!0,side:ye,depthWrite:!1});words=Y("output",{});boxes=new Map;get text(){return uS([...this.picked].map(t=>this.app.meta.faces[t].number))}toggle(t){let e=t===null?void 0:this.app.meta.faces[t];if(t===null||!e)return this.app.say("No face is there to select");this.picked.delete(t)||this.picked.add(t),this.show(),this.app.say(`${e.id} is ${this.picked.has(t)?"selected":"no longer selected"}${this.picked.size?`: ${this.text}`:""}`)}clear(){this.picked.clear(),this.show(),this.app.say("No face is selected")}show(){this.root.hidden=this.picked.size===0,this.words.value=this.text;for(let[t,e]of this.boxes)e.checked=this.picked.has(t);this.tints.clear();for(let t of this.picked)this.tints.add(this.tinted(t));this.app.stage.request()}meshes=new Map;tinted(t){let{start:e,count:n}=this.app.meta.faces[t],s=this.meshes.get(t)??new de(this.app.drawn.geometry(e,n),this.material);return this.meshes.set(t,s),s}tabled(){for(let t of document.querySelectorAll("#faces tr[data-face]")){let e=this.app.meta.faces.findIndex(s=>s.number===Number(t.dataset.face));if(e<0)continue;let n=Y("input",{type:"checkbox","aria-label":`Select ${this.app.meta.faces[e].id}`});n.addEventListener("change",()=>this.toggle(e)),t.querySelector("th").prepend(n),this.boxes.set(e,n)}}};function uS(i){let t=[];for(let n of[...i].sort((s,r)=>s-r)){let s=t[t.length-1];s&&s[s.length-1]+1===n?s.push(n):t.push([n])}let e=t.map(n=>n.length>2?`${n[0]}-${n[n.length-1]}`:n.join(","));return e.length?`F${e.join(",")}`:""}var hS=({cutters:i})=>Math.max(0,...i.flatMap(({outline:t})=>t.flatMap(({points:e})=>e.map(([n,s])=>n+s)))),Tc=class{constructor(t,e,n){this.canvas=t;this.renderer=new Cl({canvas:t,antialias:!0,alpha:!0,stencil:!0,powerPreference:"default"}),this.renderer.debug.checkShaderErrors=!1,this.renderer.setClearAlpha(0),this.renderer.autoClear=!0;let{low:s,high:r}=e.part;this.table=new Nl(yr(e.setup.z),e.setup.x,He(s,.5,r,.5),Math.max(1e-6,is(s,r)/2),()=>this.request(),n,hS(e)),new ResizeObserver(()=>this.resize()).observe(t.parentElement),t.addEventListener("webglcontextrestored",()=>this.request())}canvas;scene=new Oi;table;renderer;asked=0;before=[];after=[];begun=!1;add(...t){for(let e of t)this.scene.add(e)}beforeDraw(t){this.before.push(t)}afterDraw(t){this.after.push(t)}warm(t){this.renderer.compile(new de(new Xe,t),this.table.camera)}begin(t){let e=this.canvas.parentElement.getBoundingClientRect();this.table.resize(Math.max(1,e.width)/Math.max(1,e.height)),t(),this.begun=!0,this.resize()}request(){this.begun&&(this.asked||=requestAnimationFrame(()=>this.draw()))}draw(t=!0){cancelAnimationFrame(this.asked),this.asked=0;for(let e of this.before)e();if(this.renderer.render(this.scene,this.table.camera),t)for(let e of this.after)e()}still(){return this.draw(),this.canvas.toDataURL("image/png")}resize(){if(!this.begun)return;let t=this.canvas.parentElement.getBoundingClientRect(),[e,n]=[Math.max(1,Math.floor(t.width)),Math.max(1,Math.floor(t.height))],s=Math.min(2,devicePixelRatio||1);ei.ratio.value=s,this.renderer.setPixelRatio(s),this.renderer.setSize(e,n),this.table.resize(e/n),this.draw()}project(t){let e=new N(...t).project(this.table.camera);return[(e.x+1)/2*this.canvas.clientWidth,(1-e.y)/2*this.canvas.clientHeight]}place(t){let e=this.canvas.getBoundingClientRect();return[2*(t.clientX-e.left)/e.width-1,1-2*(t.clientY-e.top)/e.height]}};var Hm={flutes:"#e6e9ec",neck:"#c3c9cf",shank:"#9aa2aa",holder:"#5c646d"},Ec=class{group=new _n;materials={};ghost=Ep();of=null;glass=!0;constructor(){for(let t of Object.keys(Hm))this.materials[t]=ch(Hm[t]);this.group.matrixAutoUpdate=!1,this.group.visible=!1,this.seeThrough(!0)}show(t,{tip:e,axis:n}){if(this.of!==t.id){this.of=t.id;for(let o of this.group.children)o.geometry.dispose();this.group.clear();for(let{part:o,points:l}of t.outline){if(l.length<2)continue;let a=l.map(([f,d])=>new Et(Math.max(f,1e-6),d)),c=new Wr(fS(a),64),u=new de(c,this.materials[o]);u.renderOrder=5;let h=new de(c,this.ghost);h.renderOrder=4,this.group.add(h,u)}}let s=Ci(n),r=Le(s,n);this.group.matrix=new zt().makeBasis(new N(...s),new N(...n),new N(...r)).setPosition(...e),this.group.matrixWorldNeedsUpdate=!0,this.group.visible=!0}hide(){this.group.visible=!1}seeThrough(t){this.glass=t;for(let e of Object.values(this.materials))e.uniforms.opacity.value=t?.55:1,e.transparent=t,e.needsUpdate=!0}get transparent(){return this.glass}};function fS(i){let t=[];return i.forEach((e,n)=>{if(t.push(e),n===0||n+1===i.length)return;let s=e.clone().sub(i[n-1]),r=i[n+1].clone().sub(e);Math.abs(s.angleTo(r))>.45&&t.push(e.clone().addScaledVector(r,1e-5))}),t}var dS=new Float32Array;async function pS(){let i=document.getElementById("viewer");if(!i)return;performance.mark("start");let t=document.documentElement.cloneNode(!0);document.documentElement.classList.add("app");let e=Y("p",{id:"status",role:"status"}),n=Y("p",{id:"under"}),s=Y("div",{id:"frame"}),r=Y("canvas",{id:"picture",tabindex:0,role:"application","aria-label":"The part in 3D. Arrow keys turn it, Enter selects the sample in the middle, ? shows all keys."});s.append(r),i.append(s,e);let o=G=>{e.textContent=G},l=Ip(),a=Lp(l);a.catch(()=>{});let c,u=null;try{c=new Tc(r,l,()=>u?.shownVertices??dS)}catch{s.remove(),i.classList.add("without"),document.documentElement.classList.remove("app"),o("This browser shows no 3D here (WebGL is missing or switched off). The tables say all that the picture would."),document.documentElement.dataset.ready="without";return}let h=wp(Dn(l,"check"),Dn(l,"fixture"));c.warm(h);let f=await a;performance.mark("decoded");let d=new ci(l,f);u=new fc(l,f);let g=new pc(u,f,h),y=new Ec;c.add(g.group,y.group);let p=new Uo(l,f,d,u,c,g,y,new mc(c,u,g),o);p.outline=new dc(c,u);let m=new Ol(p),x=new wc(p),M=new kl(p),v=new Mc(p),S=new Vl(p,M),A=p.clip=new Dl(p),_=Vp(l),b=new Sc(p),L=new Ac(p),E=new Gl(p,t);v.tools.append(re("Select face",()=>L.toggle(p.faceShown()),{title:"Select the face of this sample (s)"}),E.here),document.querySelector("#summary .first")?.append(Y("div",{class:"tools",id:"page-tools"},Gm(()=>v.draw()),E.saveButton)),mS();let C=re("See through",()=>I(),{"aria-pressed":"true",title:"See through the tool (g)"}),I=()=>{y.seeThrough(!y.transparent),C.setAttribute("aria-pressed",String(y.transparent)),c.request()},U=re("Tool",()=>P(),{"aria-pressed":"true",title:"Show or hide the tool (t)"}),P=()=>{p.showTool(!p.toolShown),U.setAttribute("aria-pressed",String(p.toolShown))},B=Y("div",{id:"toolbar",role:"toolbar","aria-label":"Picture"},of(p),Y("label",{},"Colour by ",gS(p)),Y("label",{},"View ",xS(p)),Y("span",{class:"group"},U,C,S.root),re("?",()=>_.showModal(),{title:"Mouse and keys (?)","aria-label":"Help: mouse and keys"}),A.root);s.append(M.root,Xp(p),x.root,m.root,S.output,n),i.append(L.root),i.prepend(B),i.append(v.root),i.append(b.root,_),p.repaint(),c.begin(()=>Up(p)),performance.mark("drawn"),Fm(p,S,L,G=>{n.textContent=G}),qp(p);let H=new Bl(p);new zl(p),L.tabled(),new Ao(p),Gp(p,{spots:H,clip:A,measure:S,help:_,selection:L,glass:I,tool:P}),p.drawn.tree,performance.mark("interactive"),setTimeout(()=>{c.add(Dp(p.drawn)),performance.mark("borders"),c.request()},0),document.documentElement.dataset.ready="yes",Object.assign(window,{review:p})}function mS(){let i=document.querySelector("#why"),t=()=>{i&&(i.open=!nr.matches)};nr.addEventListener("change",t),t()}function gS(i){let t=Y("select",{id:"colouring"}),e=()=>{let n=uf(i.meta,i.cutter.id);n.some(s=>s.key===i.mode)||(i.mode="verdict"),t.replaceChildren(...n.map(({key:s,label:r})=>Y("option",{value:s,selected:s===i.mode},r)))};return t.addEventListener("change",()=>i.setMode(t.value)),i.on("cutter",e),i.on("look",()=>{t.value=i.mode}),e(),t}function xS(i){let t=Y("select",{id:"views"},Y("option",{value:""},"choose"),Y("option",{value:"f"},"fit"));for(let[e,[n]]of Object.entries(lo))t.append(Y("option",{value:e},n));return t.addEventListener("change",()=>{let{table:e}=i.stage,[,n,s]=lo[t.value]??["",e.aim.turn,e.aim.rise];e.fly(e.fitted(n,s)),t.value=""}),t}pS().catch(i=>{let t=document.getElementById("status"),e=i instanceof Error?i.message:String(i);t&&(t.textContent=`The picture cannot be shown: ${e}. The tables say all that it would.`),document.documentElement.dataset.ready="failed",console.error(i)});})();
